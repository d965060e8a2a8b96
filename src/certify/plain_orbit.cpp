#include "carom/certify/plain_orbit.hpp"

#include <algorithm>

#include "carom/base/error.hpp"
#include "certify/attempt.hpp"
#include "certify/exact_value.hpp"
#include "certify/flight_end.hpp"
#include "certify/plain.hpp"
#include "certify/pseudo_orbit.hpp"
#include "certify/system_check.hpp"

namespace carom {

namespace certify {

// Found by the flights of larmor_flight.hpp, as sin_cos is.
static Plain time_at(const Kappa<Plain>& k, const MotionOf<Plain>& motion) {
  const bool turned = sign(k.q) == Sign::negative;
  Plain h, angle;
  mpfr_abs(h.raw(), motion.half_omega.raw(), MPFR_RNDN);
  const Plain p = turned ? -k.p : k.p, y = h * (turned ? -k.q : k.q);
  mpfr_atan2(angle.raw(), y.raw(), p.raw(), MPFR_RNDN);
  return angle / h;
}

static void sin_cos(Plain& sin, Plain& cos, const Plain& angle) {
  mpfr_sin_cos(sin.raw(), cos.raw(), angle.raw(), MPFR_RNDN);
}

/// Exits as near to each other as their numbers can tell: the distance of two roots is that of a root from rounding.
template <>
struct IsolationEffort<Plain> {
  int deepest = static_cast<int>(std::max<mpfr_prec_t>(mpfr_get_default_prec() / 2, 25));
};

}  // namespace certify

const char* name_of(PlainEnd::Fate fate) {
  switch (fate) {
    case PlainEnd::completed:
      return "completed";
    case PlainEnd::escaped:
      return "escaped";
    case PlainEnd::unbounded:
      return "unbounded";
    case PlainEnd::pinned:
      return "pinned";
    case PlainEnd::lost:
      break;
  }
  return "lost";
}

namespace {

using namespace certify;

Plain plain(const Ball& x) {
  Plain r;
  arf_get_mpfr(r.raw(), arb_midref(x.raw()), MPFR_RNDN);
  return r;
}
VectorOf<Plain> plain(const BallVector& v) { return {plain(v.x), plain(v.y)}; }
geometry::Vector near(const VectorOf<Plain>& v) { return {v.x.to_double(), v.y.to_double()}; }

class Runner {
 public:
  Runner(const ExactSystem& system, const PlainTask& task)
      : system_(system), task_(task), precision_(task.bits) {
    // The numbers as written, enclosed by more bits than are kept.
    const Precision more(task.bits + 64);
    CertifiedTask enclosed;
    enclosed.collisions = 1;
    const KnownTies none;
    const Attempt start(system, enclosed, none, task.bits + 64, task.bits + 64);
    scene_ = converted<Plain>(start.scene(), [](const Ball& x) { return plain(x); });
    where_ = start.whereabouts();
    state_.position = plain(start.state().position);
    state_.velocity = plain(start.state().velocity);
    state_.standing = start.standing();
    if (task.t_max) t_max_ = plain(value_of(*task.t_max));
  }

  PlainEnd run(const std::function<bool()>& interrupted) {
    while (task_.collisions == 0 || end_.collisions < task_.collisions) {
      if (interrupted && interrupted()) break;
      const Choice choice = scene_.next(where_, state_.position, state_.velocity, state_.standing,
                                        near(state_.position), near(state_.velocity));
      if (choice.answer != Choice::wall) return ended(nothing_follows());
      PseudoState<Plain> next = state_;
      fly_to(scene_, choice.first, next);
      if (!next.position.x.is_number() || !next.position.y.is_number()) return ended(PlainEnd::lost);
      if (t_max_ && sign(next.time - *t_max_) == Sign::positive) {
        stop_at_last_time();
        break;
      }
      const Passage passage = scene_.hole_at(choice.first.wall, next.position);
      if (passage.verdict == Verdict::yes) {
        const WallOf<Plain>& wall = scene_.walls[static_cast<std::size_t>(choice.first.wall)];
        next.velocity = before_reflection(wall, next.position, next.velocity);
        state_ = std::move(next);
        end_.hole = passage.hole;
        return ended(PlainEnd::escaped);
      }
      state_ = std::move(next);
      end_.wall = choice.first.wall;
      ++end_.collisions;
    }
    return ended(PlainEnd::completed);
  }

 private:
  PlainEnd::Fate nothing_follows() const {
    if (scene_.motion.turns) return PlainEnd::pinned;
    return system_.table->extent == Extent::bounded ? PlainEnd::lost : PlainEnd::unbounded;
  }
  void stop_at_last_time() {
    fly_for<Plain>(*t_max_ - state_.time, state_.position, state_.velocity, scene_.motion);
    state_.time = *t_max_;
  }
  PlainEnd ended(PlainEnd::Fate fate) {
    end_.fate = fate;
    end_.cell = state_.cell;
    if (scene_.lattice) state_.position = state_.position + scene_.translation(state_.cell);
    end_.t = state_.time.text();
    end_.x = state_.position.x.text();
    end_.y = state_.position.y.text();
    end_.vx = state_.velocity.x.text();
    end_.vy = state_.velocity.y.text();
    return end_;
  }

  const ExactSystem& system_;
  const PlainTask& task_;
  const Plain::Precision precision_;
  SceneOf<Plain> scene_;
  Whereabouts where_;
  PseudoState<Plain> state_;
  std::optional<Plain> t_max_;
  PlainEnd end_;
};

}  // namespace

PlainEnd plain_orbit(const ExactSystem& system, const PlainTask& task,
                     const std::function<bool()>& interrupted) {
  if (task.collisions == 0 && !task.t_max)
    throw InputError(Place{}, "an orbit without an end", "a number of collisions or a last time");
  check_system(system);
  return Runner(system, task).run(interrupted);
}

}  // namespace carom
