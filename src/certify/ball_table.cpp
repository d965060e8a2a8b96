#include "certify/ball_table.hpp"

#include "certify/exact_value.hpp"
#include "certify/table_builder.hpp"

namespace carom::certify {

template <>
struct Source<Ball> {
  static Ball value(const ExactNumber& number) { return value_of(number); }
  static BallVector direction(const ExactNumber& angle, long part = 0, long whole = 1) {
    const CosSin d = direction_of(angle, part, whole);
    return {d.cos, d.sin};
  }
};

bool has_brim(const TableSpec& spec) {
  const ExactNumber &cap = spec.numbers.at("cap_radius"), &stem = spec.numbers.at("stem_width");
  const std::string difference = "2*(" + exact_text(cap) + ")-(" + exact_text(stem) + ")";
  const Sign brim = sign_of(ExactNumber(difference, stem.place()));
  if (brim == Sign::negative)
    throw InputError(stem.place(), "the stem is wider than the cap", "stem_width <= 2 cap_radius");
  if (brim == Sign::undecided)
    throw InputError(stem.place(), "whether the stem is as wide as the cap cannot be told",
                     "numbers that differ by more");
  return brim == Sign::positive;
}

BallTable ball_table(const TableSpec& spec) { return TableBuilder<Ball>(spec).build(); }

}  // namespace carom::certify
