#include "directives.hpp"

#include "ehdjet/core/edit_distance.hpp"
#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <utility>

#include "records.hpp"

namespace ehdjet {
namespace {

constexpr std::string_view all_pairs = "every step has the forces of all pairs";
constexpr std::string_view printing =
    "observables have all columns; ehdjet export writes them";
constexpr std::string_view pictures =
    "ehdjet export --xyz and --vtk write frames in metres";
constexpr std::string_view jobs = "a run can be interrupted and continued at any time";

std::vector<Directive> make_directives() {
  using enum Given;
  std::vector<Directive> all{
      {{"primary", "cutoff"}, number, all_pairs},
      {{"maximum", "displ"}, number, all_pairs},
      {{"multiple", "step", "yes"}, yes, all_pairs},
      {{"multiple", "step", "every"}, integer, all_pairs},
      {{"multiple", "step", "no"}, no, all_pairs},
      {{"cutoff"},
       number,
       all_pairs}, // JETSPIN 1.0 tries it first; it has no primary cutoff
      {{"system"}, integer},
      {{"integrator"}, integer},
      {{"units", "cgs"}, choice, {}, {}, 0},
      {{"units", "real"}, choice, {}, {}, 1},
      {{"seed"}, integer, "the phase of the nozzle is given, and no force is random"},
      {{"resolution"}},
      {{"points"}, integer},
      {{"inserting", "yes"}, yes},
      {{"inserting", "no"}, no},
      {{"removing", "yes"}, yes},
      {{"removing", "no"}, no},
      {{"lorentz", "yes"}, yes, {}, "ehdjet has no magnetic force"},
      {{"lorentz"}, nothing, "there is no magnetic force"},
      {{"magnetic", "field"}, triple, "there is no magnetic force"},
      {{"gravity", "yes"}, yes},
      {{"gravity", "no"}, no},
      {{"density", "mass"}},
      {{"density", "charge"}},
      {{"initial", "length"}},
      {{"nozzle", "cross"}},
      {{"nozzle", "stress"}},
      {{"nozzle", "velocity"}},
      {{"perturb", "yes"}, yes},
      {{"perturb", "freq"}},
      {{"perturb", "ampl"}},
      {{"perturb", "phase"}},
      {{"perturb", "no"}, no},
      {{"airdrag", "yes"}, yes},
      {{"airdrag", "amplitude"}},
      {{"airdrag", "airdensity"}},
      {{"airdrag", "airviscosity"}},
      {{"airdrag", "airvelocity"}},
      {{"airdrag", "no"}, no},
      {{"noise", "yes"}, yes},
      {{"noise", "variance"}},
      {{"noise", "diffusivity"}},
      {{"noise", "pool"}, integer},
      {{"noise", "no"}, no},
      {{"viscosity"}},
      {{"elastic", "modulus"}},
      {{"yield", "stress"}},
      {{"collector", "distance"}},
      {{"external", "potential", "vector"}, triple},
      {{"external", "potential", "phase"}},
      {{"external", "potential", "type"}, integer},
      {{"external", "potential", "freq"}},
      {{"external", "potential", "time"}},
      {{"external", "potential"}},
      {{"surface", "tension"}},
      {{"timestep"}},
      {{"final", "time"}},
      {{"printstat", "list"}, nothing, "ehdjet export --jetspin-stat has its own columns"},
      {{"printstat", "binary"}, nothing, printing},
      {{"print", "time"}},
      {{"print", "xyz", "maxnum"}, integer, pictures},
      {{"print", "xyz", "frame"}},
      {{"print", "xyz", "rescalexyz"}, number, pictures},
      {{"print", "xyz"}},
      {{"print", "pdb", "frame"}},
      {{"print", "pdb", "rescalepdb"}, number, pictures},
      {{"print", "pdb", "tagbead"}, nothing, pictures},
      {{"print", "binary"}, nothing, "the run file is HDF5"},
      {{"print", "list"}, nothing, printing},
      {{"hbfluid", "yes"}, yes},
      {{"hbfluid", "consistency"}},
      {{"hbfluid", "index"}},
      {{"hbfluid", "no"}, no},
      {{"kvfluid", "yes"}, yes},
      {{"kvfluid", "no"}, no},
      {{"variable", "mass", "yes"},
       yes,
       {},
       "ehdjet has no nanoparticles in the jet; [varicosity] makes every k-th bead "
       "heavier"},
      {{"variable", "mass"}, nothing, "no bead differs"},
      {{"dynam", "refin", "yes"}, yes},
      {{"dynam", "refin", "threshold"}},
      {{"dynam", "refin", "anchor"}},
      {{"dynam", "refin", "every"}},
      {{"dynam", "refin", "start"}},
      {{"dynam", "refin", "capacity"}, integer, "memory grows as it is needed"},
      {{"dynam", "refin", "no"}, no},
      {{"restart", "yes"},
       yes,
       {},
       "the state is in JETSPIN's save.dat, which ehdjet does not read"},
      {{"restart", "reset"}, nothing, jobs},
      {{"restart", "no"}, no, jobs},
      {{"restart", "dump"}, integer, jobs},
      {{"wall", "yes"}, yes, {}, "ehdjet has no wall that pushes beads back"},
      {{"wall"}, nothing, "there is no wall"},
      {{"dragvel", "yes", "type"},
       integer,
       {},
       "ehdjet gives a released bead half the velocity of the bead downstream, in all "
       "directions; remove the type"},
      {{"dragvel", "yes"}, yes},
      {{"dragvel", "no"}, no},
      {{"evaporation", "yes"}, yes},
      {{"evaporation", "polymer", "frac"}},
      {{"evaporation", "airviscosity"}},
      {{"evaporation", "temperature"}},
      {{"evaporation", "umidity"}},
      {{"evaporation", "bconst"}},
      {{"evaporation", "mconst"}},
      {{"evaporation", "tconst"}},
      {{"evaporation", "diffusivity"}},
      {{"evaporation", "relumidity"}},
      {{"evaporation", "no"}, no},
      {{"mirror", "yes"},
       yes,
       {},
       "import without it, then give collector.images = \"collector\" in the scene"},
      {{"mirror"}, nothing, "there are no images"},
      {{"breakup", "yes"}, yes, {}, "ehdjet's jets do not break"},
      {{"breakup"}, nothing, "jets do not break"},
      {{"ultimate", "strength"}, number, "jets do not break"},
      {{"job time"}, nothing, jobs},
      {{"close time"}, nothing, jobs},
      {{"finish"}, nothing}};
  return all;
}

/// A directive begins with the first keyword that fits, and is the first of those with the others.
const Directive* find_directive(const Record& record) {
  const auto& all = jetspin_directives();
  const auto first = std::ranges::find_if(
      all, [&](const Directive& d) { return record.has(d.keywords.front()); });
  if (first == all.end()) return nullptr;
  for (auto d = first; d != all.end(); ++d)
    if (d->keywords.front() == first->keywords.front()
        && std::ranges::all_of(d->keywords, [&](std::string_view keyword) {
             // "noise" begins with "no", too.
             return keyword == "no" ? record.has_word(keyword) : record.has(keyword);
           }))
      return &*d;
  return nullptr;
}

/// Keywords abbreviate words, so that a longer word is as near as its beginning.
std::size_t distance(std::string_view word, std::string_view keyword) {
  return std::min(edit_distance(word, keyword),
                  edit_distance(word.substr(0, keyword.size()), keyword));
}

std::string nearest_directive(const Record& record) {
  std::pair<std::size_t, std::size_t> least{std::numeric_limits<std::size_t>::max(), 0};
  const Directive* nearest = nullptr;
  for (const Directive& d : jetspin_directives()) {
    const auto words = record.words(d.keywords.size());
    std::pair<std::size_t, std::size_t> off{0, d.keywords.size()};
    for (std::size_t k = 0; k < d.keywords.size(); ++k)
      off.first +=
          k < words.size() ? distance(words[k], d.keywords[k]) : d.keywords[k].size();
    // Of equally near ones, the one that explains more words.
    if (off.first < least.first || (off.first == least.first && off.second > least.second))
      least = off, nearest = &d;
  }
  return fmt::format("{}", fmt::join(nearest->keywords, " "));
}

class Reader {
public:
  Reader(const std::string& name, Settings& settings)
      : name_(name)
      , settings_(settings) {}

  /// Returns false at `finish`.
  bool read(const Record& record) {
    if (record.is_comment()) return true;
    const Directive* directive = find_directive(record);
    if (directive == nullptr)
      fail(record,
           fmt::format("no directive. The nearest is \"{}\"{}", nearest_directive(record),
                       record.text().find('\t') == std::string::npos
                           ? ""
                           : "; tabs do not separate words"));
    if (directive->keywords.front() == "finish") return false;
    if (!directive->refused.empty())
      fail(record, fmt::format("cannot be imported: {}", directive->refused));
    keep({directive, record.line(), values(record, *directive)});
    if (record.is_cut())
      remark(record, fmt::format("what follows character {} is not read", Record::longest));
    return true;
  }

private:
  std::vector<double> values(const Record& record, const Directive& directive) const {
    switch (directive.given) {
    case Given::nothing:
      return {};
    case Given::yes:
      return {1};
    case Given::no:
      return {0};
    case Given::choice:
      return {directive.value};
    case Given::number:
      return numbers(record, 1);
    case Given::triple:
      return numbers(record, 3);
    case Given::integer:
      break;
    }
    const auto number = record.number();
    if (!number || !number->is_integer) fail(record, "needs a whole number");
    return {number->value};
  }

  std::vector<double> numbers(const Record& record, std::size_t count) const {
    std::vector<double> values;
    for (std::size_t from = 0; values.size() < count;) {
      const auto number = record.number(from);
      if (!number)
        fail(record,
             count == 1 ? "needs a number" : fmt::format("needs {} numbers", count));
      values.push_back(number->value), from = number->end;
      if (number->distant_exponent)
        remark(record, fmt::format("is read as {}: the exponent are the next digits of the "
                                   "record, as in JETSPIN",
                                   number->value));
    }
    return values;
  }

  void keep(Setting setting) {
    auto& kept = settings_.by_name[setting.directive->name()];
    if (kept.directive != nullptr)
      settings_.remarks.push_back(fmt::format("line {}: replaces line {}: {}", setting.line,
                                              kept.line, setting.directive->name()));
    kept = std::move(setting);
  }

  void remark(const Record& record, const std::string& what) const {
    settings_.remarks.push_back(
        fmt::format("line {}: \"{}\" {}", record.line(), record.shown(), what));
  }
  [[noreturn]] void fail(const Record& record, const std::string& why) const {
    throw InputError(
        fmt::format("{}:{}: \"{}\": {}", name_, record.line(), record.shown(), why));
  }

  const std::string& name_;
  Settings& settings_;
};

} // namespace

std::string Directive::name() const {
  const bool is_choice =
      given == Given::yes || given == Given::no || given == Given::choice;
  return fmt::format(
      "{}", fmt::join(keywords.begin(), keywords.end() - (is_choice ? 1 : 0), " "));
}

const std::vector<Directive>& jetspin_directives() {
  static const std::vector<Directive> all = make_directives();
  return all;
}

Settings read_settings(std::string_view text, const std::string& name) {
  Settings settings;
  Reader reader(name, settings);
  std::size_t number = 0;
  for (const std::string_view line : lines_of(text))
    if (!reader.read({line, ++number})) return settings;
  throw InputError(
      fmt::format("{}: ends after {} lines without the record \"finish\"", name, number));
}

} // namespace ehdjet
