#include "files/toml/read.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "files/svg/drawing.hpp"
#include "files/text_file.hpp"
#include "files/toml/number_lines.hpp"
#include "files/toml/toml_section.hpp"
#include "table/closed_curves.hpp"

namespace carom::files {
namespace {

using namespace table::shapes;

Value value_of(const ExactNumber& number, const Place& place) {
  const std::string& text = number.text();
  const bool decimal = text.find_first_not_of("0123456789.-+e") == std::string::npos;
  return decimal ? number_value(text, place) : text_value(text, place);
}

Value value_of(const ExactPoint& point, const Place& place) {
  Value value = empty_value(Value::Kind::list, place);
  value.items = {value_of(point.x, place), value_of(point.y, place)};
  return value;
}

Value value_of(const WrittenPiece& written, const std::string& name) {
  const PieceSpec& piece = written.piece;
  const Place& place = piece.place;
  Value value = empty_value(Value::Kind::table, place), to = value_of(piece.to, place);
  switch (piece.kind) {
    case PieceSpec::Kind::line:
      value.set("line_to", std::move(to));
      break;
    case PieceSpec::Kind::arc:
      value.set("arc_via", value_of(piece.via, place));
      value.set("arc_to", std::move(to));
      break;
    case PieceSpec::Kind::ellipse:
      value.set("ellipse_via", value_of(piece.via, place));
      value.set("ellipse_to", std::move(to));
      value.set("ellipse_ratio", value_of(piece.ratio, place));
      value.set("ellipse_angle", value_of(piece.angle, place));
      break;
    case PieceSpec::Kind::bezier: {
      Value points = empty_value(Value::Kind::list, place);
      for (const ExactPoint& p : piece.control) points.items.push_back(value_of(p, place));
      points.items.push_back(std::move(to));
      value.set("bezier", std::move(points));
      break;
    }
  }
  if (!name.empty()) value.set("name", text_value(name, place));
  return value;
}

/// The keys of a loop, or of an obstacle, which names its shape.
Value value_of(const DrawnLoop& loop, bool obstacle) {
  const Place& place = loop.place;
  Value value = empty_value(Value::Kind::table, place);
  const auto shape = [&](const char* name) {
    if (obstacle) value.set("shape", text_value(name, place));
  };
  const NamedCurve& first = loop.chain.front();
  if (const auto* circle = std::get_if<WrittenCircle>(&first.curve)) {
    shape("circle");
    value.set("center", value_of(circle->centre, place));
    value.set("radius", value_of(circle->radius, place));
  } else if (const auto* ellipse = std::get_if<WrittenEllipse>(&first.curve)) {
    shape("ellipse");
    value.set("center", value_of(ellipse->centre, place));
    value.set("a", value_of(ellipse->a, place));
    value.set("b", value_of(ellipse->b, place));
    value.set("angle", value_of(ellipse->angle, place));
  } else {
    shape("path");
    value.set("start", value_of(std::get<WrittenPiece>(first.curve).from, place));
    Value pieces = empty_value(Value::Kind::list, place);
    for (const NamedCurve& piece : loop.chain)
      pieces.items.push_back(value_of(std::get<WrittenPiece>(piece.curve), piece.name));
    value.set("pieces", std::move(pieces));
    return value;
  }
  if (!first.name.empty()) value.set("name", text_value(first.name, place));
  return value;
}

Rational scale_of(const Value& written) {
  const ExactNumber number = as_number(written);
  const auto ratio = number.to_rational();
  if (!ratio || !(number.to_double() > 0.0))
    throw InputError(written.place, "a drawing cannot be scaled by " + written.text,
                     "a positive number without roots");
  return Rational(ratio->numerator + "/" + ratio->denominator);
}

/// The curve with the largest area.
std::size_t outermost(const std::vector<DrawnLoop>& loops) {
  std::size_t outer = 0;
  double largest = -1.0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const double area = std::fabs(area_of(loops[k].chain));
    if (!(area > largest)) continue;
    largest = area;
    outer = k;
  }
  return outer;
}

}  // namespace

void take_drawing(Value& table) {
  const Value* shape = table.find("shape");
  if (shape == nullptr || shape->text != "svg") return;
  const Place shape_place = shape->place;
  TomlSection section(table, "table", "svg");
  section.check_keys();
  const Value path = section.get("path");
  as_text(path);
  const Rational scale = scale_of(section.get("scale"));
  const std::string name = located(path);
  constexpr std::size_t most_of_drawing = std::size_t{64} << 20;
  const std::string text =
      text_of_file(name, most_of_drawing, path.place, "'" + name + "' ", "a drawing (SVG)");
  std::vector<DrawnLoop> loops = loops_of_drawing(text, name, scale);
  const std::size_t outer = outermost(loops);
  if (const auto& first = loops[outer].chain.front().curve;
      std::holds_alternative<WrittenPiece>(first))
    loops[outer].chain = turned(std::move(loops[outer].chain), false);
  Value loop = empty_value(Value::Kind::list, path.place),
        obstacles = empty_value(Value::Kind::list, path.place);
  loop.items.push_back(value_of(loops[outer], false));
  for (std::size_t k = 0; k < loops.size(); ++k)
    if (k != outer) obstacles.items.push_back(value_of(loops[k], true));
  if (Value* more = table.find("obstacle")) {
    as_sections(*more, "shape = \"circle\"");
    for (Value& one : more->items) obstacles.items.push_back(std::move(one));
  }
  table.erase("path");
  table.erase("scale");
  table.set("shape", text_value("path", shape_place));
  table.set("loop", std::move(loop));
  if (!obstacles.items.empty()) table.set("obstacle", std::move(obstacles));
}

}  // namespace carom::files
