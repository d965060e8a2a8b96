#include "certify/wall/ball_table.hpp"

#include "certify/number/exact_value.hpp"
#include "certify/wall/table_builder.hpp"

namespace carom::certify {

template <>
struct Source<Ball> {
  static Ball value(const ExactNumber& number) { return value_of(number); }
  static BallVector direction(const ExactNumber& angle, long part = 0, long whole = 1) {
    const CosSin d = direction_of(angle, part, whole);
    return {d.cos, d.sin};
  }
};

BallTable ball_table(const TableSpec& spec) { return table_of<Ball>(spec); }

}  // namespace carom::certify
