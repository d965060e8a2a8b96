// What the page draws of a system, and which of its numbers a slider can change.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "engines/followed_deviations.hpp"
#include "files/toml/value.hpp"
#include "systems.hpp"

namespace carom::page {

namespace {

using files::Value;

Json numbers(std::initializer_list<double> all) {
  Json list = Json::array();
  for (const double x : all) list.push(x);
  return list;
}

// Points of a curve between two parameters, near enough to each other for the eye.
Json points(const geometry::CurveFrame& frame, double from, double to) {
  const bool straight = frame.kind == geometry::CurveFrame::Kind::segment;
  const int pieces = straight ? 1 : std::max(4, static_cast<int>(std::ceil(48.0 * (to - from))));
  Json list = Json::array();
  for (int i = 0; i <= pieces; ++i) {
    const geometry::Vector p = geometry::point_at(frame, from + (to - from) * i / pieces);
    list.push(p.x).push(p.y);
  }
  return list;
}

Json walls(const OpenSystem& open) {
  const Table& table = *open.system().table;
  Json list = Json::array();
  for (std::size_t w = 0; w < table.walls.size(); ++w) {
    const Wall& wall = table.walls[w];
    const bool drawn = !is_inner_side(table, static_cast<int>(w));  // else its other side is
    const double end = geometry::end_parameter(wall.curve);
    list.push(Json::object()
                  .set("name", wall.name)
                  .set("points", drawn ? points(open.frames[w], 0.0, end) : Json::array())
                  .set("closed", geometry::is_closed(wall.curve))
                  .set("hole", false)
                  .set("passed", is_passed(wall))
                  .set("length", open.offsets[w + 1] - open.offsets[w])
                  .set("offset", open.offsets[w]));
  }
  for (const Hole& hole : table.holes) {
    const auto w = static_cast<std::size_t>(hole.wall);
    const double end = geometry::end_parameter(table.walls[w].curve), to = std::min(hole.to, end),
                 s = geometry::arc_length_at(open.frames[w], hole.from);
    const double s_to = to < end ? geometry::arc_length_at(open.frames[w], to)
                                 : open.offsets[w + 1] - open.offsets[w];
    list.push(Json::object()
                  .set("name", hole.name)
                  .set("points", points(open.frames[w], hole.from, to))
                  .set("closed", false)
                  .set("hole", true)
                  .set("passed", true)
                  .set("length", s_to - s)
                  .set("offset", open.offsets[w] + s));
  }
  return list;
}

// Around the walls and the cell; where there are neither, around the start of a particle.
Json box(const OpenSystem& open) {
  const Table& table = *open.system().table;
  geometry::Vector low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  const auto enclose = [&](geometry::Vector p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  };
  for (const Wall& wall : table.walls) {
    const geometry::Box b = geometry::bounding_box(wall.curve);
    enclose(b.low);
    enclose(b.high);
  }
  if (!(low.x <= high.x)) {
    const geometry::Vector start = open.system().initial.position;
    enclose(start - geometry::Vector{2.0, 2.0});
    enclose(start + geometry::Vector{2.0, 2.0});
  }
  return numbers({low.x, low.y, high.x, high.y});
}

const KeyDescription* description(std::string section, const std::string& kind,
                                  const std::string& key) {
  for (std::size_t at; (at = section.find('[')) != section.npos;)  // of lists: every element's
    section.erase(at, section.find(']') - at + 1);
  const KeyDescription* found = nullptr;
  for (const KeyDescription& one : key_table()) {
    if (one.section != section || one.key != key) continue;
    const std::string kinds = "|" + std::string(one.kind) + "|";
    if (one.kind.empty() || kinds.find("|" + kind + "|") != kinds.npos) return &one;
    if (!found) found = &one;
  }
  return found;
}

void add_keys(const Value& table, const std::string& section, Json& list) {
  const Value* kind = table.find("shape");
  if (!kind) kind = table.find("kind");
  for (const files::Entry& entry : table.entries) {
    const Value& value = entry.value;
    const std::string inner = section.empty() ? entry.key : section + "." + entry.key;
    if (value.kind == Value::Kind::table) add_keys(value, inner, list);
    if (value.kind == Value::Kind::list)
      for (std::size_t i = 0; i < value.items.size(); ++i)
        if (value.items[i].kind == Value::Kind::table)
          add_keys(value.items[i], inner + "[" + std::to_string(i) + "]", list);
    if (value.kind != Value::Kind::number && value.kind != Value::Kind::text) continue;
    const KeyDescription* about = description(section, kind ? kind->text : "", entry.key);
    if (!about || about->type == "string" || about->type == "formula") continue;
    Json json = Json::object();
    json.set("section", section).set("key", entry.key);
    try {
      json.set("value", ExactNumber(value.text, value.place).to_double());
    } catch (const InputError&) {
      continue;  // a word
    }
    list.push(
        json.set("type", about->type).set("meaning", about->meaning).set("line", value.place.line));
  }
}

// Why orbits have no exponents; "" where they have.
std::string why_no_rates(const System& system) {
  try {
    engines::refuse_no_deviations(system);
    return {};
  } catch (const InputError& error) {
    return error.problem();
  }
}

}  // namespace

Json outline(const OpenSystem& open) {
  const System& system = open.system();
  const auto& lattice = system.table->lattice;
  Json keys = Json::array();
  add_keys(files::parse_document(open.toml, open.name), "", keys);
  const Value root = files::parse_document(open.loaded.resolved_toml, open.name);
  const Value* field = root.find("field") ? root.find("field")->find("B") : nullptr;
  return Json::object()
      .set("name", open.name)
      .set("title", system.title.empty() ? system.name : system.title)
      .set("keys", std::move(keys))
      .set("walls", walls(open))
      .set("box", box(open))
      .set("lattice", lattice ? numbers({lattice->first.x, lattice->first.y, lattice->second.x,
                                         lattice->second.y})
                              : Json())
      .set("length", open.offsets.back())
      .set("potential", system.has_forces())
      .set("field", field ? ExactNumber(field->text, field->place).to_double() : 0.0)
      .set("particles", system.particles.size())
      .set("no_rates", why_no_rates(system));
}

}  // namespace carom::page
