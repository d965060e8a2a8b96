#include "plain_orbit.hpp"

#include <mpfr.h>

#include <algorithm>

#include "certify/attempt.hpp"
#include "certify/flight/pseudo_orbit.hpp"

namespace carom::certify {

/// An MPFR number.
class Plain {
 public:
  /// Bits of results in this thread, while it lives.
  class Precision {
   public:
    explicit Precision(mpfr_prec_t bits) : before_(mpfr_get_default_prec()) {
      mpfr_set_default_prec(bits);
    }
    ~Precision() { mpfr_set_default_prec(before_); }
    Precision(const Precision&) = delete;
    Precision& operator=(const Precision&) = delete;

   private:
    mpfr_prec_t before_;
  };

  Plain() : Plain(0.0) {}
  Plain(int value) : Plain(static_cast<double>(value)) {}  // NOLINT: values convert
  Plain(double value) {                                    // NOLINT
    mpfr_init(x_);
    mpfr_set_d(x_, value, MPFR_RNDN);
  }
  Plain(const Plain& o) {
    mpfr_init(x_);
    mpfr_set(x_, o.x_, MPFR_RNDN);
  }
  Plain(Plain&& o) noexcept : Plain() { mpfr_swap(x_, o.x_); }
  Plain& operator=(const Plain& o) {
    mpfr_set(x_, o.x_, MPFR_RNDN);
    return *this;
  }
  Plain& operator=(Plain&& o) noexcept {
    mpfr_swap(x_, o.x_);
    return *this;
  }
  ~Plain() { mpfr_clear(x_); }

  friend Plain operator+(const Plain& a, const Plain& b) { return made(mpfr_add, a, b); }
  friend Plain operator-(const Plain& a, const Plain& b) { return made(mpfr_sub, a, b); }
  friend Plain operator*(const Plain& a, const Plain& b) { return made(mpfr_mul, a, b); }
  friend Plain operator/(const Plain& a, const Plain& b) { return made(mpfr_div, a, b); }
  friend Plain operator-(const Plain& a) {
    Plain r;
    mpfr_neg(r.x_, a.x_, MPFR_RNDN);
    return r;
  }
  friend Plain sqrt(const Plain& a) {
    Plain r;
    mpfr_sqrt(r.x_, a.x_, MPFR_RNDN);
    return r;
  }
  friend Plain square(const Plain& a) { return a * a; }
  friend Sign sign(const Plain& a) {
    const int s = mpfr_sgn(a.x_);
    return s > 0 ? Sign::positive : s < 0 ? Sign::negative : Sign::zero;
  }

  double to_double() const { return mpfr_get_d(x_, MPFR_RNDN); }
  /// With as many digits as the precision holds.
  std::string text() const {
    const auto digits = static_cast<int>(static_cast<double>(mpfr_get_prec(x_)) * 0.30103);
    char* printed = nullptr;
    mpfr_asprintf(&printed, "%.*RNg", digits, x_);
    std::string result(printed);
    mpfr_free_str(printed);
    return result;
  }
  mpfr_ptr raw() { return x_; }
  mpfr_srcptr raw() const { return x_; }

 private:
  template <class Operation>
  static Plain made(Operation operation, const Plain& a, const Plain& b) {
    Plain r;
    operation(r.x_, a.x_, b.x_, MPFR_RNDN);
    return r;
  }
  mpfr_t x_;
};

/// For a choice between formulas of the same number.
inline double middle_of(const Plain& x) { return x.to_double(); }

// Found by the flights of larmor_flight.hpp.
static Plain time_at(const Kappa<Plain>& k, const MotionOf<Plain>& motion) {
  const bool turned = sign(k.q) == Sign::negative;
  Plain h, angle;
  mpfr_abs(h.raw(), motion.half_omega.raw(), MPFR_RNDN);
  const Plain p = turned ? -k.p : k.p, y = h * (turned ? -k.q : k.q);
  mpfr_atan2(angle.raw(), y.raw(), p.raw(), MPFR_RNDN);
  return angle / h;
}

/// Exits as near to each other as their numbers can tell: the distance of two roots is that of a
/// root from rounding.
template <>
struct IsolationEffort<Plain> {
  int deepest = static_cast<int>(std::max<mpfr_prec_t>(mpfr_get_default_prec() / 2, 25));
};

}  // namespace carom::certify

namespace carom::bench {

using namespace certify;

namespace {

Plain plain(const Ball& x) {
  Plain r;
  arf_get_mpfr(r.raw(), arb_midref(x.raw()), MPFR_RNDN);
  return r;
}
VectorOf<Plain> plain(const BallVector& v) { return {plain(v.x), plain(v.y)}; }
geometry::Vector near(const VectorOf<Plain>& v) { return {v.x.to_double(), v.y.to_double()}; }

}  // namespace

PlainEnd plain_orbit(const ExactSystem& system, std::uint64_t collisions, long bits) {
  const Plain::Precision kept(bits);
  // The numbers as written, enclosed by more bits than are kept.
  const Precision more(bits + 64);
  CertifiedTask task;
  task.collisions = 1;
  const KnownTies none;
  const Attempt start(system, task, none, bits + 64, bits + 64);
  const auto scene = converted<Plain>(start.scene(), [](const Ball& x) { return plain(x); });
  PseudoState<Plain> state;
  state.position = plain(start.state().position);
  state.velocity = plain(start.state().velocity);
  state.standing = start.standing();
  PlainEnd end;
  while (end.collisions < collisions) {
    const Choice choice = scene.next(start.whereabouts(), state.position, state.velocity,
                                     state.standing, near(state.position), near(state.velocity));
    if (choice.answer != Choice::wall) break;
    fly_to(scene, choice.first, state);
    end.wall = state.standing;
    ++end.collisions;
  }
  end.cell = state.cell;
  if (scene.lattice) state.position = state.position + scene.translation(state.cell);
  end.t = state.time.text();
  end.x = state.position.x.text();
  end.y = state.position.y.text();
  end.vx = state.velocity.x.text();
  end.vy = state.velocity.y.text();
  return end;
}

}  // namespace carom::bench
