// Straight walls and round caps: stadium, mushroom, lemon.
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::shapes {

using geometry::CircularArc;
using geometry::Segment;
using geometry::Vector;

// Half circles have offset 0: their tangents at the ends are exactly at right angles to the chord, so
// that they join the straight walls without a corner.

void stadium(const TableSpec& spec, Table& table) {
  const double a = size(spec, "half_length");
  const double r = size(spec, "radius");
  const Vector south_west{-a, -r}, south_east{a, -r}, north_east{a, r}, north_west{-a, r};
  add_loop(table, {{"bottom", Segment{south_west, south_east}},
                   {"right", CircularArc{south_east, north_east, 0.0, true}},
                   {"top", Segment{north_east, north_west}},
                   {"left", CircularArc{north_west, south_west, 0.0, true}}});
}

void mushroom(const TableSpec& spec, Table& table) {
  const double cap = size(spec, "cap_radius");
  const ExactNumber& stem_width = number(spec, "stem_width");
  const double half = size_of(stem_width, "stem_width") / 2;
  const double height = size(spec, "stem_height");
  if (half > cap) {
    throw InputError(stem_width.place(), "the stem is wider than the cap", "stem_width <= 2 cap_radius");
  }
  const Vector foot_left{-half, -height}, foot_right{half, -height};
  const Vector neck_right{half, 0}, neck_left{-half, 0}, cap_right{cap, 0}, cap_left{-cap, 0};
  std::vector<NamedCurve> chain{{"stem_bottom", Segment{foot_left, foot_right}},
                                {"stem_right", Segment{foot_right, neck_right}}};
  const bool brim = half < cap;  // a stem as wide as the cap leaves no brim: cap and stem join smoothly
  if (brim) chain.push_back({"brim_right", Segment{neck_right, cap_right}});
  chain.push_back({"cap", CircularArc{cap_right, cap_left, 0.0, true}});
  if (brim) chain.push_back({"brim_left", Segment{cap_left, neck_left}});
  chain.push_back({"stem_left", Segment{neck_left, foot_left}});
  add_loop(table, std::move(chain));
}

void lemon(const TableSpec& spec, Table& table) {
  const ExactNumber& radius = number(spec, "radius");
  const ExactNumber& separation = number(spec, "separation");
  size_of(radius, "radius");
  size_of(separation, "separation");
  const std::string r = quoted(radius), d = quoted(separation);
  if (derived("2*" + r + "-" + d, separation).to_double() <= 0) {
    throw InputError(separation.place(), "the two circles do not overlap", "separation < 2 radius");
  }
  // The circles about (-d/2, 0) and (d/2, 0) meet at (0, ±h); in units of the chord 2h a centre lies
  // d/(4h) beside the chord's middle.
  const std::string h = "sqrt(" + r + "^2-" + d + "^2/4)";
  const double tip = size_of(derived(h, radius), "half the height of the lemon");
  const double offset = derived(d + "/(4*" + h + ")", separation).to_double();
  const Vector south{0, -tip}, north{0, tip};
  add_loop(table, {{"right", CircularArc{south, north, offset, true}},
                   {"left", CircularArc{north, south, offset, true}}});
}

}  // namespace carom::shapes
