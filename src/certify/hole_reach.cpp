#include "certify/hole_reach.hpp"

#include "carom/table/table.hpp"
#include "certify/exact_sign.hpp"
#include "certify/hole.hpp"
#include "certify/with_pi.hpp"

namespace carom::certify {
namespace {

using Vector = VectorOf<Quadratic>;

class Reach {
 public:
  /// `known`: its wall, if that is known to some bits already.
  Reach(const ExactSystem& system, const HoleSpec& spec, const WallOf<Ball>* known = nullptr)
      : system_(system),
        spec_(spec),
        known_(known),
        wall_(static_cast<std::size_t>(system.table->wall_index(spec.wall))) {}

  Sign before_start() const { return sign_of(end_of(")-(")); }
  Sign past_end() const { return past_length(end_of(")+(")); }
  Sign too_wide() const { return past_length(spec_.width); }

 private:
  ExactNumber end_of(const char* side) const {
    return {"(" + exact_text(spec_.center) + side + exact_text(spec_.width) + ")/2", spec_.place};
  }

  // Of an arc length less that of the wall.
  Sign past_length(const ExactNumber& s) const {
    const auto wall = [&] {
      return known_ && Precision::bits() == bits_of_a_first_look ? *known_
                                                                 : ball_table(*system_.spec).walls[wall_];
    };
    return sign_by([&] { return value_of(s) - arc_length(wall()); }, [&] { return by_algebra(s); });
  }

  std::optional<Sign> by_algebra(const ExactNumber& s) const {
    const WallOf<Quadratic> w = TableBuilder<Quadratic>(*system_.spec).build().walls[wall_];
    if (w.form == Form::ellipse) throw NotQuadratic("an arc length of an ellipse");
    if (w.form == Form::segment)  // squares, for the length is a root; neither is negative
      return sign(square(Quadratic(s)) - dot(w.chord, w.chord));
    const WithPi length(Quadratic(), Quadratic(twelfths(w)) / Quadratic(12) * sqrt(w.radius2));
    return is_zero(WithPi(s) - length) ? std::optional(Sign::zero) : std::nullopt;
  }

  // The angle of an arc in units of pi/12.
  int twelfths(const WallOf<Quadratic>& w) const {
    if (w.closed) return 24;
    const Vector from = w.from - w.centre, to = w.to - w.centre;
    for (int k = 1; k < 24; ++k) {
      try {
        const Vector turn = twenty_fourth(w.turn > 0 ? k : -k);
        if (is_zero(turn.x * from + turn.y * left(from) - to)) return k;
      } catch (const NotQuadratic&) {  // another root than these points have
      }
    }
    throw NotQuadratic("an arc whose angle is no multiple of pi/12");
  }

  const ExactSystem& system_;
  const HoleSpec& spec_;
  const WallOf<Ball>* known_;
  std::size_t wall_;
};

}  // namespace

HoleReach reach_of(const ExactSystem& system, const HoleSpec& spec) {
  const Reach reach(system, spec);
  return {reach.before_start(), reach.past_end()};
}

bool is_all_of_its_wall(const ExactSystem& system, const HoleSpec& spec, const WallOf<Ball>& wall) {
  const Reach reach(system, spec, &wall);
  const auto at_least = [](Sign s) { return s == Sign::zero || s == Sign::positive; };
  if (wall.closed) return at_least(reach.too_wide());
  const Sign start = reach.before_start();
  return (start == Sign::zero || start == Sign::negative) && at_least(reach.past_end());
}

}  // namespace carom::certify
