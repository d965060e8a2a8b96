#include "files/toml/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "files/toml/nesting.hpp"
#include "files/toml/read.hpp"
#include "files/toml/toml_section.hpp"

namespace carom::files {
namespace {

Place command_line(const std::string& key) { return {command_line_file, 0, 0, key}; }

struct Step {
  std::string key;
  std::vector<std::size_t> indices;
};

std::vector<Step> steps_of(const std::string& path) {
  const auto levels =
      1 + std::count_if(path.begin(), path.end(), [](char c) { return c == '.' || c == '['; });
  if (static_cast<std::size_t>(levels) > most_levels)
    throw InputError(command_line("--set"), "a path of " + std::to_string(levels) + " levels",
                     "at most " + std::to_string(most_levels));
  const InputError bad(command_line("--set"), "cannot read the path '" + path + "'",
                       "path.to.key=value, with an index as in table.hole[0].width=0.2");
  std::vector<Step> steps;
  for (std::size_t start = 0; start <= path.size();) {
    const std::size_t end = std::min(path.find('.', start), path.size());
    const std::string part = path.substr(start, end - start);
    std::size_t bracket = std::min(part.find('['), part.size());
    Step step{part.substr(0, bracket), {}};
    if (step.key.empty()) throw bad;
    while (bracket < part.size()) {
      const std::size_t close = part.find(']', bracket);
      if (part[bracket] != '[' || close == std::string::npos) throw bad;
      std::size_t index = 0;
      const char* last = part.data() + close;
      const auto [stop, error] = std::from_chars(part.data() + bracket + 1, last, index);
      if (error != std::errc{} || stop != last) throw bad;
      step.indices.push_back(index);
      bracket = close + 1;
    }
    steps.push_back(std::move(step));
    start = end + 1;
  }
  return steps;
}

// Removes the key of the file that the new key excludes.
void drop_rival(Value& section, const std::string& key) {
  static const std::pair<const char*, const char*> rivals[] = {{"B", "larmor_radius"},
                                                               {"speed", "energy"},
                                                               {"radius", "radii"},
                                                               {"velocity", "angle"},
                                                               {"step", "step_chosen"}};
  for (const auto& [one, other] : rivals) {
    if (key == one) section.erase(other);
    if (key == other) section.erase(one);
  }
}

// "x,y" of --position and --velocity, "from:to" of --window.
Value pair_of(const std::string& text, const Place& place, char between = ',',
              const std::string& expected = "x,y such as 0.5,1/3") {
  const std::size_t middle = text.find(between);
  if (middle == std::string::npos || text.find(between, middle + 1) != std::string::npos) {
    throw InputError(place, "'" + text + "' is not a pair of numbers", expected);
  }
  Value value = empty_value(Value::Kind::list, place);
  value.items = {parse_value(text.substr(0, middle), place),
                 parse_value(text.substr(middle + 1), place)};
  return value;
}

Value window_of(const std::string& text) {
  const std::size_t comma = text.find(',');
  const bool with_comma = comma != std::string::npos && text.find(':') == std::string::npos;
  return pair_of(
      text, command_line("--window"), ':',
      with_comma ? text.substr(0, comma) + ":" + text.substr(comma + 1) : "from:to such as 20:200");
}

void place_start(const SystemOverrides& overrides, Value& root) {
  if (overrides.position.empty() && overrides.velocity.empty()) return;
  const Place place = command_line(overrides.position.empty() ? "--velocity" : "--position");
  Value* old = root.find("initial");
  const Value* kind = old == nullptr ? nullptr : old->find("kind");
  Value initial =
      kind != nullptr && kind->text == "point" ? *old : empty_value(Value::Kind::table, place);
  const auto refuse_typed = [&](const char* key, const char* beside) {
    const Value* typed = old == nullptr ? nullptr : old->find(key);
    if (typed != nullptr && typed->place.file == command_line_file)
      throw InputError(typed->place, std::string("initial.") + key + " is given beside " + beside,
                       "one of them");
  };
  if (kind != nullptr && kind->text != "point") refuse_typed("kind", place.key.c_str());
  if (!overrides.position.empty()) refuse_typed("position", "--position");
  for (const char* key : {"velocity", "angle"})
    if (!overrides.velocity.empty()) refuse_typed(key, "--velocity");
  // Keys of the start that --set gives count, whatever kind of start the file has.
  for (const char* key : {"position", "velocity", "angle"}) {
    const Value* typed = old == nullptr ? nullptr : old->find(key);
    if (typed != nullptr && typed->place.file == command_line_file) initial.set(key, *typed);
  }
  initial.set("kind", text_value("point", place));
  if (!overrides.position.empty())
    initial.set("position", pair_of(overrides.position, command_line("--position")));
  if (!overrides.velocity.empty()) {
    initial.set("velocity", pair_of(overrides.velocity, command_line("--velocity")));
    initial.erase("angle");
  }
  if (initial.find("position") == nullptr) {
    throw InputError(place, "no position is given", "--position x,y beside --velocity");
  }
  if (initial.find("velocity") == nullptr && initial.find("angle") == nullptr) {
    throw InputError(place, "no velocity is given",
                     "--velocity u,v or --set initial.angle=A beside --position");
  }
  root.set("initial", std::move(initial));
}

// Are the report times those that a system with this t_max and without times is given? A stored
// system has them written out.
bool has_default_times(const Value& root, const Value& t_max) {
  const Value* run = root.find("run");
  const Value* times = run == nullptr ? nullptr : run->find("times");
  if (times == nullptr || times->entries.size() != 4) return false;
  const Value wanted = default_times(t_max, times->place);
  return std::all_of(wanted.entries.begin(), wanted.entries.end(), [&](const Entry& entry) {
    const Value* written = times->find(entry.key);
    return written != nullptr && written->text == entry.value.text;
  });
}

}  // namespace

void set_path(Value& root, const std::string& path, Value value) {
  const std::vector<Step> steps = steps_of(path);
  const Place place = value.place;
  Place made = place;  // of a section that is not there yet
  made.key.clear();
  Value* at = &root;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Step& step = steps[k];
    made.key += (k == 0 ? "" : ".") + step.key;
    if (at->kind != Value::Kind::table) {
      throw InputError(place, "'" + steps[k - 1].key + "' is " + name_of(at->kind) +
                                  ", it has no key '" + step.key + "'");
    }
    const bool last = k + 1 == steps.size();
    if (last && step.indices.empty()) drop_rival(*at, step.key);
    Value* next = at->find(step.key);
    if (next == nullptr) {
      const Value::Kind kind = step.indices.empty() ? Value::Kind::table : Value::Kind::list;
      next = &at->set(step.key, empty_value(kind, made));
    }
    for (const std::size_t index : step.indices) {
      if (next->kind != Value::Kind::list) {
        throw InputError(place, "'" + step.key + "' is " + name_of(next->kind) + ", not a list");
      }
      if (index > next->items.size()) {
        throw InputError(
            place, "there is no '" + step.key + "[" + std::to_string(index) + "]'",
            next->items.empty()
                ? "the index 0, to append the first"
                : "an index below " + std::to_string(next->items.size()) + ", or that to append");
      }
      made.key += "[" + std::to_string(index) + "]";
      if (index == next->items.size()) next->items.push_back(empty_value(Value::Kind::table, made));
      next = &next->items[index];
    }
    if (last) {
      *next = std::move(value);
      return;
    }
    at = next;
  }
}

void apply(const SystemOverrides& overrides, Value& root) {
  const Value* written = root.find("run") == nullptr ? nullptr : root.find("run")->find("t_max");
  const Value old_t_max = written == nullptr ? Value{} : *written;
  for (const auto& [path, text] : overrides.set)
    set_path(root, path, parse_value(text, command_line(path)));
  const std::pair<const char*, const std::string*> options[] = {
      {"seed", &overrides.seed},   {"trajectories", &overrides.trajectories},
      {"t_max", &overrides.t_max}, {"collisions", &overrides.collisions},
      {"times", &overrides.times}, {"trust_tolerance", &overrides.trust_tolerance}};
  for (const auto& [key, text] : options) {
    if (text->empty()) continue;
    std::string option = std::string("--") + key;
    std::replace(option.begin(), option.end(), '_', '-');
    const Place place = command_line(option);
    // Times have a notation of their own, which read_run takes apart.
    const Value value =
        std::string(key) == "times" ? text_value(*text, place) : parse_value(*text, place);
    set_path(root, std::string("run.") + key, value);
  }
  // Default times go along with t_max.
  if (!old_t_max.text.empty() && has_default_times(root, old_t_max) &&
      root.find("run")->find("t_max")->text != old_t_max.text)
    root.find("run")->erase("times");
  if (!overrides.window.empty()) set_path(root, "run.window", window_of(overrides.window));
  place_start(overrides, root);
}

void halve_step(LoadedSystem& loaded) {
  double& step = loaded.system.dynamics.integrator.step;
  step *= 0.5;
  Value root = parse_document(loaded.resolved_toml, loaded.system.name);
  Value* const written = root.find("integrator")->find("step");
  *written = number_value(fmt::format("{}", step), written->place);
  loaded.resolved_toml = print_document(root);
}

}  // namespace carom::files
