#include "base/parts.hpp"
#include "files/toml/overrides.hpp"
#include "files/toml/read.hpp"

namespace carom::files {
namespace {

constexpr std::uint64_t most_times = 100000;

// "log:from:to:count", "lin:from:to:count" or "a,b,c", as --times takes it.
Value parse_times(const Value& written) {
  const std::string& text = written.text;
  const bool grid = text.find(':') != std::string::npos;
  const std::vector<std::string> parts = base::parts_of(text, grid ? ':' : ',');
  Value value;
  value.place = written.place;
  if (!grid) {
    value.kind = Value::Kind::list;
    for (const std::string& part : parts) value.items.push_back(parse_value(part, written.place));
    return value;
  }
  if (parts.size() != 4 || (parts[0] != "log" && parts[0] != "lin")) {
    throw InputError(written.place, "cannot read the times '" + text + "'",
                     "a,b,c or log:from:to:count or lin:from:to:count");
  }
  value.kind = Value::Kind::table;
  value.set("from", parse_value(parts[1], written.place));
  value.set("to", parse_value(parts[2], written.place));
  value.set("count", parse_value(parts[3], written.place));
  value.set("spacing", text_value(parts[0] == "log" ? "log" : "linear", written.place));
  return value;
}

}  // namespace

Value default_times(const Value& t_max, const Place& place) {
  Value value;
  value.place = place;
  Value to = t_max;
  to.place = place;
  value.set("from", text_value("(" + t_max.text + ")/1000", place));
  value.set("to", to);
  value.set("count", number_value("31", place));
  value.set("spacing", text_value("log", place));
  return value;
}

namespace {

std::vector<double> read_grid(Value& value) {
  TomlSection section(value, "run.times");
  section.check_keys();
  Value& from = section.get("from");
  Value& to = section.get("to");
  Value& count = section.get("count");
  const Value& spacing = section.get("spacing");
  const std::string name = as_text(spacing);
  if (name != "log" && name != "linear") {
    throw InputError(spacing.place, "unknown spacing '" + name + "'", "\"log\" or \"linear\"",
                     nearest_name(name, {"log", "linear"}));
  }
  const double first = name == "log" ? as_positive(from) : as_double(from);
  const double last = as_double(to);
  if (first < 0) throw InputError(from.place, "must not be negative", "a time >= 0");
  if (!(first < last)) throw InputError(to.place, "the times end before they begin", "to > from");
  std::vector<double> times = spaced(first, last, as_count(count, 2, most_times), name == "log");
  const auto repeated =
      std::adjacent_find(times.begin(), times.end(), [](double a, double b) { return !(a < b); });
  if (repeated != times.end())
    throw InputError(count.place,
                     "that many times between " + shown(first) + " and " + shown(last) +
                         " are closer together than doubles",
                     "fewer times");
  return times;
}

std::vector<double> read_list(const Value& value) {
  std::vector<double> times;
  if (value.items.empty()) throw InputError(value.place, "the list is empty", "at least one time");
  if (value.items.size() > most_times)
    throw InputError(value.place, std::to_string(value.items.size()) + " times are too many",
                     "at most " + std::to_string(most_times) + " times");
  for (const Value& item : value.items) {
    const double t = as_double(item);
    if (t < 0)
      throw InputError(item.place, "must not be negative, but is " + item.text, "a time >= 0");
    if (!times.empty() && t <= times.back()) {
      throw InputError(item.place, "the times do not increase at " + item.text,
                       "times in increasing order");
    }
    times.push_back(t);
  }
  return times;
}

bool on_command_line(const Value& value) { return value.place.file == command_line_file; }

Value list_of(const std::vector<double>& numbers, const Place& place) {
  Value value;
  value.kind = Value::Kind::list;
  value.place = place;
  for (const double x : numbers) value.items.push_back(number_value(ExactNumber(x).text(), place));
  return value;
}

// Times of the file beyond a shorter t_max of the command line are left out, and t_max is the last.
std::vector<double> read_times(TomlSection& run, double t_max) {
  Value& times = run.fill("times", default_times(run.get("t_max"), run.place_of("times")));
  if (times.kind == Value::Kind::text || times.kind == Value::Kind::number)
    times = parse_times(times);
  if (times.kind != Value::Kind::list && times.kind != Value::Kind::table) {
    throw InputError(times.place, "must be a list of times or a table, not " + name_of(times.kind),
                     "[1, 10, 100] or {from, to, count, spacing}");
  }
  std::vector<double> result =
      times.kind == Value::Kind::list ? read_list(times) : read_grid(times);
  if (result.back() <= t_max) return result;
  const bool cut_short = on_command_line(run.get("t_max")) && !on_command_line(times);
  if (!cut_short) {
    throw InputError(times.place,
                     "the time " + shown(result.back()) + " comes after t_max = " + shown(t_max),
                     "times up to run.t_max");
  }
  std::erase_if(result, [t_max](double t) { return t >= t_max; });
  result.push_back(t_max);
  times = list_of(result, times.place);
  return result;
}

}  // namespace

RunPlan read_run(Value& root, std::uint64_t starts) {
  TomlSection section(*root.find("run"), "run");
  section.check_keys();
  RunPlan plan;
  if (starts > 0)
    section.fill("trajectories",
                 number_value(std::to_string(starts), section.place_of("trajectories")));
  plan.t_max = as_positive(section.get("t_max"));
  plan.trajectories = as_count(section.get("trajectories"), 1, std::uint64_t{1} << 62);
  plan.seed = as_count(section.get("seed"), 0);
  if (const Value* collisions = section.find("collisions"))
    plan.collisions = as_count(*collisions, 1);
  if (const Value* sample = section.find("sample")) plan.sample = as_positive(*sample);
  const Value& tolerance = section.get("trust_tolerance");
  plan.trust_tolerance = as_positive(tolerance);
  if (!(plan.trust_tolerance < 1.0))
    throw InputError(tolerance.place, "the tolerance is as large as the table", "a number below 1");
  plan.times = read_times(section, plan.t_max);
  if (const Value* window = section.find("window")) {
    if (window->kind != Value::Kind::list || window->items.size() != 2)
      throw InputError(window->place, "must be two times", "[from, to]");
    const double from = as_double(window->items[0]), to = as_double(window->items[1]);
    if (!(from >= 0 && from < to))
      throw InputError(window->place, "the window is empty", "0 <= from < to");
    plan.window = {from, to};
  }
  if (const Value* paths = section.find("free_paths")) plan.free_paths = as_flag(*paths);
  if (const Value* spectrum = section.find("spectrum")) plan.spectrum = as_flag(*spectrum);
  return plan;
}

}  // namespace carom::files
