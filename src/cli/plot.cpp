#include "ehdjet/core/error.hpp"
#include "ehdjet/core/new_file.hpp"
#include "ehdjet/io/plot_page.hpp"
#include "ehdjet/scene/recorded_scene.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <memory>
#include <sstream>
#include <string_view>
#include <sys/mman.h>
#include <system_error>
#include <tuple>
#include <unistd.h>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "glyphs.hpp"
#include "options.hpp"
#include "program.hpp"
#include "standard_streams.hpp"
#include "words.hpp"

namespace ehdjet::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string run, output, size;
  std::vector<std::string> compared, panels;
  std::optional<double> time;
  double frames_per_second = 20;
  bool movie = false, fixed_axes = false, force = false;
};

/// While it lives, writing to a pipe that nobody reads fails instead of ending the process.
class NoBrokenPipes {
public:
  NoBrokenPipes()
      : before_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~NoBrokenPipes() { std::signal(SIGPIPE, before_); }
  NoBrokenPipes(const NoBrokenPipes&) = delete;
  NoBrokenPipes& operator=(const NoBrokenPipes&) = delete;

private:
  void (*before_)(int);
};

/// gnuplot, without the user's settings, as it draws to `output`.
class Gnuplot {
public:
  explicit Gnuplot(int output)
      : Gnuplot(make_pipe(), output) {}

  void draw(std::string_view commands) {
    const NoBrokenPipes none;
    while (!commands.empty()) {
      const ssize_t n = ::write(commands_.get(), commands.data(), commands.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) finish(); // it has stopped, and its exit code says so
      if (n < 0) throw RunError("gnuplot stopped before the end");
      commands.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  void finish() {
    commands_.close();
    program_.wait();
    pass_words_on();
    program_.finish();
  }

private:
  Gnuplot(Pipe pipe, int output)
      : words_(::memfd_create("gnuplot", MFD_CLOEXEC))
      , program_({"gnuplot", "--default-settings", "-"}, "install gnuplot-nox",
                 pipe.out.get(), output, words_.get() < 0 ? STDERR_FILENO : words_.get())
      , commands_(std::move(pipe.in)) {}

  // All it says but the number of frames of a movie, which is no fault.
  void pass_words_on() {
    std::string words;
    std::array<char, 4096> part{};
    off_t at = 0;
    for (ssize_t n = 0; (n = ::pread(words_.get(), part.data(), part.size(), at)) > 0;
         at += n)
      words.append(part.data(), static_cast<std::size_t>(n));
    std::istringstream lines(words);
    for (std::string line; std::getline(lines, line);)
      if (!line.ends_with("frames in animation sequence")) message("{}\n", line);
  }

  Descriptor words_;
  Program program_;
  Descriptor commands_; // destroyed first: gnuplot ends when there are no more
};

/// Whether the file has an end: gnuplot does not tell that the disk is full.
bool is_whole_picture(const fs::path& file, const fs::path& extension) {
  constexpr std::size_t most = 32;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::size_t>(std::max<std::streamoff>(in.tellg(), 0));
  std::string end(std::min(size, most), '\0');
  in.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  in.read(end.data(), static_cast<std::streamsize>(end.size()));
  if (extension == ".mp4") return size > 0; // ffmpeg tells it
  if (extension == ".gif") return end.ends_with(';');
  if (extension == ".png") return end.ends_with("IEND\xAE\x42\x60\x82");
  return end.find(extension == ".pdf" ? "%%EOF" : "</svg>") != std::string::npos;
}

/// How many frames of a movie are drawn: on a terminal in one line, otherwise now and then.
class DrawnFrames {
public:
  explicit DrawnFrames(std::size_t all)
      : all_(all) {}
  ~DrawnFrames() {
    if (terminal_ && shown_) write_to_terminal("\r\033[K");
  }
  DrawnFrames(const DrawnFrames&) = delete;
  DrawnFrames& operator=(const DrawnFrames&) = delete;

  void show(std::size_t drawn) {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    if (elapsed < next_) return;
    next_ = elapsed + (terminal_ ? 0.2 : 10);
    shown_ = true;
    write_to_terminal(fmt::format(
        "{}frame {} of {}, {:.0f} s left{}", terminal_ ? "\r\033[K" : "", drawn, all_,
        elapsed / static_cast<double>(drawn) * static_cast<double>(all_ - drawn),
        terminal_ ? "" : "\n"));
  }

private:
  std::size_t all_;
  bool terminal_ = ::isatty(STDERR_FILENO) != 0, shown_ = false;
  double next_ = terminal_ ? 0.2 : 10; // [s]
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void draw_movie(const PlotPage& page, const fs::path& output, double frames_per_second,
                const fs::path& drawn, int drawing) {
  const std::vector<double> times = page.frame_times();
  if (times.empty()) throw InputError("there are no frames to make a movie of");
  const std::string start = page.terminal(output, frames_per_second);
  // gnuplot makes GIF movies itself; ffmpeg makes MP4 of the PNG images that gnuplot draws.
  std::optional<Program> encoder;
  std::optional<Pipe> images; // closed first: the encoder ends when there are no more
  if (output.extension() == ".mp4") {
    images.emplace(make_pipe());
    encoder.emplace(
        std::vector<std::string>{"ffmpeg", "-loglevel", "error", "-y", "-f", "image2pipe",
                                 "-framerate", fmt::format("{:g}", frames_per_second),
                                 "-c:v", "png", "-i", "-", "-vf",
                                 "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p",
                                 "-f", "mp4", drawn.string()},
        "install ffmpeg, or choose a name that ends in .gif", images->out.get(), drawing);
    images->out.close();
  }
  {
    Gnuplot gnuplot(images ? images->in.get() : drawing);
    if (images) images->in.close();
    gnuplot.draw(start);
    DrawnFrames progress(times.size());
    for (std::size_t k = 0; k < times.size(); ++k) {
      gnuplot.draw(page.draw(times[k]));
      progress.show(k + 1);
    }
    gnuplot.finish();
  }
  if (encoder) encoder->finish();
}

/// WIDTHxHEIGHT in pixels.
std::pair<double, double> size_of(const std::string& text) {
  double width = 0, height = 0;
  const char* end = text.data() + text.size();
  const auto [middle, no_width] = std::from_chars(text.data(), end, width);
  if (no_width == std::errc() && middle != end && *middle == 'x') {
    const auto [last, no_height] = std::from_chars(middle + 1, end, height);
    if (no_height == std::errc() && last == end) return {width, height};
  }
  throw InputError("--size " + text + ": must be WIDTHxHEIGHT in pixels, as 1600x1200");
}

/// What a page says of each run: its file and what its scene has otherwise.
std::vector<std::string> labels_of(const std::deque<RunReader>& runs) {
  std::vector<std::string> scenes, labels;
  for (const RunReader& run : runs) scenes.push_back(run.scene("resolved"));
  const std::vector<std::string> changed = distinctions(scenes);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    labels.push_back(runs[k].path().filename().string());
    if (!changed[k].empty()) labels.back() += ":  " + changed[k];
  }
  return labels;
}

PlotPage page_of(const std::deque<RunReader>& runs, const PageOptions& options,
                 const fs::path& output) {
  std::vector<std::string> texts = labels_of(runs);
  std::string title = title_of(runs[0].scene("resolved"));
  for (const RunReader& run : runs) // a comparison has the title that all have
    if (title_of(run.scene("resolved")) != title) title.clear();
  texts.push_back(title);
  if (output.extension()
      != ".svg") { // which is drawn where it is seen, with the fonts there
    const std::string without = replace_without_glyphs(texts);
    if (!without.empty())
      message("note: no font here has {}: ? stands for them. Install one, as "
              "fonts-noto-cjk\n",
              without);
  }
  std::vector<PlottedRun> plotted;
  for (std::size_t k = 0; k < runs.size(); ++k)
    plotted.push_back({&runs[k], texts[k], has_nozzle(runs[k].scene("resolved"))});
  return {std::move(plotted), texts.back(), options};
}

/// Names between commas, each of which is that of a panel.
std::vector<std::string> panels_of(const std::vector<std::string>& given) {
  std::vector<std::string> known, panels;
  for (const auto& [name, what] : page_panels()) known.push_back(name);
  for (const std::string& list : given)
    for (std::size_t start = 0, end = 0; end != std::string::npos; start = end + 1) {
      end = list.find(',', start);
      const std::string name = list.substr(start, end - start);
      if (std::ranges::find(known, name) == known.end())
        throw InputError(fmt::format("--panels {}: {}; the panels are {}", list,
                                     name.empty() ? "a name is empty"
                                                  : "there is no panel " + name
                                                        + nearest_name(name, known),
                                     fmt::join(known, ", ")));
      panels.push_back(name);
    }
  return panels;
}

void run_plot(const Options& options) {
  std::deque<RunReader> runs; // in place
  runs.emplace_back(options.run);
  for (const std::string& other : options.compared) runs.emplace_back(other);
  const fs::path output =
      options.output.empty()
          ? fs::path(options.run).replace_extension(options.movie ? "gif" : "png")
          : fs::path(options.output);
  for (const RunReader& run : runs) refuse_input(output, run.path());

  PageOptions page_options{.panels = panels_of(options.panels),
                           .fixed_axes = options.fixed_axes,
                           .movie = options.movie};
  if (options.movie) page_options.width = 960, page_options.height = 720;
  if (!options.size.empty())
    std::tie(page_options.width, page_options.height) = size_of(options.size);
  const PlotPage page = page_of(runs, page_options, output);
  // What is wrong is said before anything is drawn.
  const std::string commands =
      options.movie ? "" : page.terminal(output) + page.draw(options.time);
  const double frames_per_second =
      options.movie && output.extension() == ".gif"
          ? PlotPage::gif_frames_per_second(options.frames_per_second)
          : options.frames_per_second;
  if (std::abs(frames_per_second - options.frames_per_second) > 1e-9)
    message("note: {:.4g} frames per second instead of {:g}: a GIF shows each for whole "
            "hundredths of a second\n",
            frames_per_second, options.frames_per_second);
  if (!page.left_out().empty())
    message("note: no room for {} on {:g}x{:g} pixels: --size makes room, --panels "
            "chooses\n",
            fmt::join(page.left_out(), ", "), page_options.width, page_options.height);

  NewFile file(output, options.force);
  const fs::path& drawn = file.create();
  {
    const Descriptor drawing(::open(drawn.c_str(), O_WRONLY | O_CLOEXEC)); // NOLINT
    if (drawing.get() < 0)
      throw InputError("cannot create " + output.string() + ": " + std::strerror(errno));
    if (options.movie) {
      draw_movie(page, output, frames_per_second, drawn, drawing.get());
    } else {
      Gnuplot gnuplot(drawing.get());
      gnuplot.draw(commands);
      gnuplot.finish();
    }
  }
  if (!file.is_stream() && !is_whole_picture(drawn, output.extension()))
    throw RunError("cannot write " + output.string()
                   + ": gnuplot did not finish the picture. Is the disk full?");
  file.publish();
  say_written(output, !options.output.empty());
}

} // namespace

void add_plot_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "plot", "Draw a run, several runs or a movie of one (needs gnuplot)");
  add_run_file_option(*command, options->run);
  command
      ->add_option(
          "-o,--output", options->output,
          "Page to draw; default: RUN.png, of a movie RUN.gif, beside the run file. "
          "Movies may be .mp4 where ffmpeg is installed")
      ->type_name("FILE.{png,svg,pdf,gif,mp4}");
  command
      ->add_option(
          "--compare", options->compared,
          "Draw further runs in the same axes; the legend says in which keys they differ")
      ->type_name("RUN")
      ->expected(1, static_cast<int>(PlotPage::most_runs) - 1);
  CLI::Option* time =
      command
          ->add_option("--time", options->time,
                       "Draw the frame nearest to this time [s]; default: the last one")
          ->type_name("T")
          ->check(finite_number());
  CLI::Option* movie =
      command
          ->add_flag("--movie", options->movie,
                     "Draw all frames of the run, in the same axes; a compared run that "
                     "is over keeps its last frame")
          ->excludes(time);
  command
      ->add_option(
          "--frames-per-second", options->frames_per_second,
          "Speed of the movie; of a GIF up to 50, for whole hundredths of a second "
          "per frame")
      ->needs(movie)
      ->check(CLI::Range(0.5, 100.0))
      ->capture_default_str();
  std::string panels;
  for (const auto& [name, what] : page_panels())
    panels += fmt::format("{}{} ({})", panels.empty() ? "" : ", ", name, what);
  command
      ->add_option("--panels", options->panels,
                   "Only these panels, with commas between them: " + panels
                       + ". Default: all of which the file has data and for which there is "
                         "room, in a movie the jet's; a note says which have no room")
      ->type_name("NAMES");
  command
      ->add_option(
          "--size", options->size,
          fmt::format("Size of the page in pixels, from {:g}x{:g} on; in PDF 108 are an "
                      "inch. Default: 1600x1200, of a movie 960x720",
                      PlotPage::least_width, PlotPage::least_height))
      ->type_name("WIDTHxHEIGHT");
  command->add_flag(
      "--fixed-axes", options->fixed_axes,
      "Axes that have room for all frames, so that pictures of different times "
      "can be compared");
  command->add_flag("--force", options->force, "Overwrite existing output");
  command->callback([options] { run_plot(*options); });
}

} // namespace ehdjet::cli
