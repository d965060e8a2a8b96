// Straight walls and round caps: stadium, mushroom, lemon.
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {

Shape stadium(const TableSpec& spec) {
  const ExactNumber &a = number(spec, "half_length"), &r = number(spec, "radius"),
                    west = negative(a), south = negative(r);
  size_of(a, "half_length");
  size_of(r, "radius");
  const ExactPoint south_west{west, south}, south_east{a, south}, north_east{a, r},
      north_west{west, r};
  return {{{{"bottom", WrittenSegment{south_west, south_east}},
            {"right", WrittenArc{south_east, north_east, {a, 0}, r, 0}},
            {"top", WrittenSegment{north_east, north_west}},
            {"left", WrittenArc{north_west, south_west, {west, 0}, r, 0}}}}};
}

Shape mushroom(const TableSpec& spec) {
  const ExactNumber &cap = number(spec, "cap_radius"), &stem_width = number(spec, "stem_width");
  const ExactNumber right = half(stem_width), left = negative(right);
  const ExactNumber floor = negative(number(spec, "stem_height"));
  size_of(cap, "cap_radius");
  size_of(stem_width, "stem_width");
  size_of(number(spec, "stem_height"), "stem_height");
  if (right.to_double() > cap.to_double())
    throw InputError(stem_width.place(), "the stem is wider than the cap",
                     "stem_width <= 2 cap_radius");
  const ExactPoint foot_left{left, floor}, foot_right{right, floor};
  const ExactPoint neck_right{right, 0}, neck_left{left, 0}, cap_right{cap, 0},
      cap_left{negative(cap), 0};
  Chain chain{{"stem_bottom", WrittenSegment{foot_left, foot_right}},
              {"stem_right", WrittenSegment{foot_right, neck_right}}};
  // A stem as wide as the cap leaves no brim: cap and stem join smoothly.
  const bool brim = right.to_double() < cap.to_double();
  if (brim) chain.push_back({"brim_right", WrittenSegment{neck_right, cap_right}});
  chain.push_back({"cap", WrittenArc{cap_right, cap_left, {}, cap, 0}});
  if (brim) chain.push_back({"brim_left", WrittenSegment{cap_left, neck_left}});
  chain.push_back({"stem_left", WrittenSegment{neck_left, foot_left}});
  return {{chain}};
}

Shape lemon(const TableSpec& spec) {
  const ExactNumber& radius = number(spec, "radius");
  const ExactNumber& separation = number(spec, "separation");
  size_of(radius, "radius");
  size_of(separation, "separation");
  const std::string r = quoted(radius), d = quoted(separation);
  if (derived("2*" + r + "-" + d, separation).to_double() <= 0) {
    throw InputError(separation.place(), "the two circles do not overlap", "separation < 2 radius");
  }
  // The circles about (-d/2, 0) and (d/2, 0) meet at (0, ±h); in units of the chord 2h a centre
  // lies d/(4h) beside the chord's middle.
  const std::string h = "sqrt(" + r + "^2-" + d + "^2/4)";
  const ExactNumber tip = derived(h, radius), offset = derived(d + "/(4*" + h + ")", separation);
  size_of(tip, "half the height of the lemon");
  const ExactPoint south{0, negative(tip)}, north{0, tip};
  return {{{{"right", WrittenArc{south, north, {negative(half(separation)), 0}, radius, offset}},
            {"left", WrittenArc{north, south, {half(separation), 0}, radius, offset}}}}};
}

}  // namespace carom::table::shapes
