# Settings of Sphinx. `docs/build` copies the pages and what it generates into one folder and builds them there.
import os

project = "ehdjet"
author = copyright = "The ehdjet developers"
release = version = os.environ["EHDJET_VERSION"]

extensions = ["myst_parser", "breathe"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build"]
myst_heading_anchors = 3
# Pages that are also read in the repository link to files which are not pages.
suppress_warnings = ["myst.xref_missing", "myst.header"]

breathe_projects = {"ehdjet": os.environ.get("EHDJET_DOXYGEN_XML", "xml")}
breathe_default_project = "ehdjet"

html_theme = "alabaster"
html_theme_options = {"description": "Electrospinning jets as charged viscoelastic bead chains",
                      "page_width": "70em", "sidebar_width": "15em", "fixed_sidebar": True}
html_show_sourcelink = False
