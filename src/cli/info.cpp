#include "ehdjet/run_files/run_reader.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "scenes.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

namespace fs = std::filesystem;

std::string json(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text)
    if (c == '"' || c == '\\')
      quoted += '\\', quoted += c;
    else if (static_cast<unsigned char>(c) < 0x20)
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      quoted += c;
  return quoted + '"';
}

std::string json(double number) {
  return std::isfinite(number) ? fmt::format("{}", number) : "null";
}

/// What is said about a file, once for people and once for programs.
class Facts {
public:
  /// A text.
  void say(const char* name, const std::string& text) { add(name, name, text, json(text)); }
  /// A number with its unit, which is a part of its name for programs.
  void say(const char* name, double number, const char* unit = "") {
    const std::string suffix = *unit == '\0' ? "" : fmt::format("_{}", unit);
    add(name, name + suffix,
        fmt::format("{:.9g}{}{}", number, suffix.empty() ? "" : " ", unit), json(number));
  }
  /// Rows of a part of a run, and their times.
  void say_part(const char* name, std::size_t rows, const std::vector<double>& times,
                const std::string& more = "", const std::string& more_json = "") {
    std::string text = fmt::format("{}", rows), object = fmt::format("{{\"rows\":{}", rows);
    if (!times.empty()) {
      text += fmt::format(", t = {:.6g} to {:.6g} s", times.front(), times.back());
      object += fmt::format(",\"from_s\":{},\"to_s\":{}", json(times.front()),
                            json(times.back()));
    }
    add(name, name, text + more, object + more_json + '}');
  }

  [[nodiscard]] std::string text() const {
    std::string lines;
    for (const Fact& f : facts_) {
      std::string label = f.name;
      for (char& c : label)
        if (c == '_') c = ' ';
      lines += fmt::format("{:<19}{}\n", label, f.text);
    }
    return lines;
  }
  [[nodiscard]] std::string as_json() const {
    std::string object;
    for (const Fact& f : facts_)
      object += fmt::format("{}\n  {}:{}", object.empty() ? "{" : ",", json(f.key), f.json);
    return object + "\n}\n";
  }

private:
  struct Fact {
    std::string name, key, text, json;
  };
  void add(std::string name, std::string key, std::string text, std::string value) {
    facts_.push_back({std::move(name), std::move(key), std::move(text), std::move(value)});
  }
  std::vector<Fact> facts_;
};

std::string kind_of_jet(const SceneConfig& c) {
  if (c.array) return fmt::format("{} x {} jets", c.array->rows, c.array->columns);
  if (c.chain) return "a given chain of beads";
  return c.nozzle->inflow == InflowKind::pump ? "fed by a pump" : "drawn from a nozzle";
}

void describe(Facts& facts, const SceneConfig& c) {
  if (!c.title.empty()) facts.say("title", c.title);
  facts.say("jet", kind_of_jet(c));
  facts.say("end_time", c.run.end_time, "s");
  if (c.coulomb) facts.say("solver", c.coulomb->solver);
  facts.say("integrator", c.integrator.method);
}

void describe_parts(Facts& facts, const RunReader& run) {
  if (run.has("observables")) {
    const auto times = run.column("observables", "time");
    facts.say_part("observables", times.size(), times);
  }
  if (run.has("frames")) {
    const auto times = run.frame_times();
    if (times.empty()) {
      facts.say_part("frames", 0, times);
    } else {
      const BeadRange last = run.frame_rows().back();
      const std::size_t beads = last.end - last.begin;
      facts.say_part("frames", times.size(), times,
                     fmt::format("; {} beads in the last one", beads),
                     fmt::format(",\"beads_in_last\":{}", beads));
    }
  }
  for (const char* part : {"deposit", "refinements", "budget", "resolving_power"})
    if (run.has(part)) {
      const auto times = run.column(part, "time");
      facts.say_part(part, times.size(), times);
    }
}

std::string status_text(const RunReader& run) {
  const std::string status = run.attribute("status");
  if (status != "running" || run.is_being_written()) return status;
  return "killed"; // nobody was left to say so in the file
}

Facts facts_of_run(const fs::path& file) {
  const RunReader run(file);
  Facts facts;
  facts.say("file", file.string());
  facts.say("kind", "run");
  facts.say("status", status_text(run));
  if (const std::string reason = run.attribute("message"); !reason.empty())
    facts.say("message", reason);
  facts.say("scene", run.attribute("scene_file"));
  describe(facts, config_of(run.scene("resolved")));
  describe_parts(facts, run);
  if (run.has("observables"))
    if (const auto beads = run.column("observables", "beads"); !beads.empty())
      facts.say("beads", beads.back());
  if (const auto checkpoint = run.last_checkpoint())
    if (const auto time = checkpoint->find("time");
        time != checkpoint->end() && !time->second.empty())
      facts.say("checkpoint", time->second.front(), "s");
  for (const char* name : {"continued_from", "continued_at", "resumed_at"})
    if (run.has_attribute(name)) facts.say(name, run.attribute(name));
  const auto cost = run.statistics();
  for (const char* name : {"evaluations", "steps", "rejected", "full_sums"})
    if (cost.contains(name)) facts.say(name, cost.at(name));
  if (cost.contains("wall_time")) facts.say("wall_time", cost.at("wall_time"), "s");
  if (run.has_attribute("coulomb")) facts.say("coulomb", run.attribute("coulomb"));
  facts.say("size", static_cast<double>(fs::file_size(file)) / 1e6, "MB");
  for (const char* name : {"version", "commit", "compiler", "simd", "threads"})
    if (run.has_attribute(name)) facts.say(name, run.attribute(name));
  return facts;
}

Facts facts_of_scene(const fs::path& file) {
  const Scene scene = read_scene(file);
  const OutputConfig& output = scene.config.output;
  Facts facts;
  facts.say("file", file.string());
  facts.say("kind", "scene");
  describe(facts, scene.config);
  if (scene.config.chain) facts.say("beads", static_cast<double>(scene.chain.size()));
  if (output.observables) facts.say("observables_every", *output.observables, "s");
  if (output.frames) facts.say("frames_every", *output.frames, "s");
  return facts;
}

} // namespace

void add_info_command(CLI::App& app) {
  struct Options {
    std::string file;
    bool as_json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("info", "Say what a run file or a scene holds");
  command
      ->add_option("FILE", options->file,
                   "Run file (HDF5), scene file (TOML) or name of a scene")
      ->required();
  command->add_flag("--json", options->as_json, "Print JSON");
  command->callback([options] {
    const fs::path file = find_scene(options->file);
    const Facts facts = is_run_file(file) ? facts_of_run(file) : facts_of_scene(file);
    print_result("{}", options->as_json ? facts.as_json() : facts.text());
  });
}

} // namespace ehdjet::cli
