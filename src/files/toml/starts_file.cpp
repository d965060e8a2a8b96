#include "files/toml/read.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "files/toml/number_lines.hpp"
#include "files/toml/toml_section.hpp"

namespace carom::files {
namespace {

/// How many particles there are, as [particles] tells.
std::size_t count_of(const Value& particles) {
  if (const Value* count = particles.find("count")) return as_count(*count, 1, 1000000);
  for (const char* key : {"mass", "charge"}) {
    const Value* list = particles.find(key);
    if (list != nullptr && list->kind == Value::Kind::list && !list->items.empty())
      return list->items.size();
  }
  return 1;
}

/// The length of a start's velocity; below 0 if it is none.
struct Length {
  double rounded = -1.0;
  Value exact;
};
Length length_of(const Value& start) {
  const std::vector<ExactNumber> numbers = as_numbers(start);
  if (numbers.size() != 4) return {};
  const ExactNumber &x = numbers[2], &y = numbers[3];
  const double length = std::sqrt(x.to_double() * x.to_double() + y.to_double() * y.to_double());
  if (length == 1.0) return {length, number_value("1", start.place)};
  if (y.to_double() == 0.0 && x.to_double() > 0.0)
    return {length, text_value(x.text(), start.place)};
  if (x.to_double() == 0.0 && y.to_double() > 0.0)
    return {length, text_value(y.text(), start.place)};
  return {length, text_value("sqrt((" + x.text() + ")^2+(" + y.text() + ")^2)", start.place)};
}

}  // namespace

void take_speeds_from_starts(Value& root) {
  const Value& initial = *root.find("initial");
  Value& particles = *root.find("particles");
  const Value *kind = initial.find("kind"), *starts = initial.find("starts");
  if (kind == nullptr || kind->text != "list" || starts == nullptr) return;
  if (starts->kind != Value::Kind::list || starts->items.empty()) return;
  if (particles.find("speed") != nullptr || particles.find("energy") != nullptr) return;
  // Trajectory after trajectory, a particle comes to each start that is a multiple of this away
  // from its first one.
  const std::size_t count = count_of(particles), apart = std::gcd(count, starts->items.size());
  std::vector<Length> lengths;
  const bool may_rest = root.find("potential") != nullptr || root.find("interaction") != nullptr;
  for (std::size_t i = 0; i < starts->items.size(); ++i) {
    const Length length = length_of(starts->items[i]);
    if (!(length.rounded > 0.0) && !(length.rounded == 0.0 && may_rest))
      return;  // read_initial reports this fault
    if (i < apart) {
      lengths.push_back(length);
      continue;
    }
    const double first = lengths[i % apart].rounded;
    if (std::fabs(length.rounded - first) <= 0x1p-40 * first)
      continue;  // directions are rounded when written
    throw InputError(
        starts->items[i].place,
        "the speed differs from that of the start before, and a particle keeps its speed",
        "velocities of one length; or a speed or energy in [particles]: velocities "
        "then give directions");
  }
  const bool equal = std::all_of(lengths.begin(), lengths.end(), [&](const Length& l) {
    return l.rounded == lengths.front().rounded;
  });
  if (equal) {
    particles.set("speed", lengths.front().exact);
    return;
  }
  Value speeds;
  speeds.kind = Value::Kind::list;
  speeds.place = starts->place;
  for (std::size_t k = 0; k < count; ++k) speeds.items.push_back(lengths[k % apart].exact);
  particles.set("speed", std::move(speeds));
}

void take_starts_from_file(Value& initial) {
  const Value* kind = initial.find("kind");
  if (kind == nullptr || kind->text != "file") return;
  TomlSection section(initial, "initial", "file");
  section.check_keys();
  const Value& path = section.get("path");
  as_text(path);
  Value starts = rows_of_file(located(path), path.place, {"start", "x y vx vy", 4, 4});
  initial.find("kind")->text = "list";
  initial.erase("path");
  initial.set("starts", std::move(starts));
}

}  // namespace carom::files
