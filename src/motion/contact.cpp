#include "motion/contact.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "carom/geometry/formulas.hpp"
#include "carom/geometry/prepared_curve.hpp"
#include "motion/free_motion.hpp"

namespace carom::motion {

using geometry::Vector;

double time_to_contact(Vector d, Vector v, double omega, double reach) {
  const double b = dot(d, v);
  if (omega == 0.0 && !(b < 0.0)) return no_contact;  // moving apart, for ever
  const double distance2 = dot(d, d), reach2 = reach * reach;
  const double gap = distance2 - reach2;
  if (gap <= 0.0 && b < 0.0) return 0.0;
  const double v2 = dot(v, v);
  if (omega == 0.0) {
    // |d + v t| = reach; reach^2 v^2 - (d x v)^2 is b^2 - gap v^2 without its cancellation.
    const double across = geometry::cross(d, v);
    const double length = std::sqrt(v2);
    const double discriminant = (reach * length - across) * (reach * length + across);
    if (!(discriminant > 0.0)) return no_contact;
    return gap / (std::sqrt(discriminant) - b);
  }
  if (!(v2 > 0.0)) return no_contact;
  // The relative motion is a Larmor flight of the same omega against a circle: the crossing at
  // which the distance falls. For a pair that has just touched (gap = 0, b > 0) the formula does
  // not see the gap.
  const geometry::Quadratic<double> q = geometry::circle_quadratic(d, reach2, v, v2, omega, 0.5);
  const double discriminant = q.b * q.b - q.a * q.c;
  if (!(discriminant > 0.0)) return no_contact;
  const double root = std::sqrt(discriminant);
  const double kappa = q.b < 0.0 ? (root - q.b) / q.a : -q.c / (q.b + root);
  if (!std::isfinite(kappa)) return no_contact;
  const double h = 0.5 * std::fabs(omega);
  return kappa > 0x1p500 * h ? 1.0 / kappa : base::angle(kappa, h) / h;
}

namespace {

/// The squared distance less the squared reach, and how it changes.
class Gap {
 public:
  Gap(const PairFlight& pair, double reach)
      : pair_(pair),
        reach2_(reach * reach),
        acceleration_(std::fabs(pair.first_omega) * length(pair.first) +
                      std::fabs(pair.second_omega) * length(pair.second)) {}

  struct At {
    double gap, rate;        ///< g, dg/dt
    double distance, speed;  ///< |d|, |dd/dt|
  };
  At at(double t) const {
    const auto [x1, v1] = moved({}, pair_.first, pair_.first_omega, t);
    const auto [x2, v2] = moved({}, pair_.second, pair_.second_omega, t);
    const Vector d = pair_.separation + (x1 - x2), v = v1 - v2;
    return {dot(d, d) - reach2_, 2.0 * dot(d, v), length(d), length(v)};
  }
  /// A bound of |d2g/dt2| within h of the time of `m`: |g''| <= 2 |d'|^2 + 2 |d| |d''|.
  double curvature(const At& m, double h) const {
    const double speed = m.speed + acceleration_ * h;
    const double distance = m.distance + speed * h;
    return 2.0 * (speed * speed + distance * acceleration_);
  }
  /// An interval to begin with, which depends on the pair alone: a share of a turn.
  double stride() const {
    const double omega = std::max(std::fabs(pair_.first_omega), std::fabs(pair_.second_omega));
    return omega > 0.0 ? 1.0 / omega
                       : std::sqrt(reach2_) / (length(pair_.first) + length(pair_.second));
  }

 private:
  const PairFlight& pair_;
  double reach2_, acceleration_;
};

/// The zero between a < b of a falling gap, to the last digits: Newton's steps, halved where they
/// leave.
double refined(const Gap& gap, double a, double b) {
  double t = 0.5 * (a + b);
  for (int i = 0; i < 200 && a < t && t < b; ++i) {
    const Gap::At now = gap.at(t);
    if (now.gap == 0.0) return t;
    (now.gap > 0.0 ? a : b) = t;
    double next = t - now.gap / now.rate;
    if (!(next > a && next < b)) next = 0.5 * (a + b);
    if (next == t) return t;
    if (std::fabs(next - t) <= 2.0 * geometry::unit_roundoff * t) return next;
    t = next;
  }
  return t;
}

/// The first fall through zero in [a, b], or no_contact.
double first_fall(const Gap& gap, double a, double b, int depth) {
  const double h = 0.5 * (b - a), middle = a + h;
  const Gap::At m = gap.at(middle);
  const double bend = gap.curvature(m, h) * h;
  if (m.gap - std::fabs(m.rate) * h - 0.5 * bend * h > 0.0)
    return no_contact;  // positive throughout
  const bool falls = m.rate<-bend, rises = m.rate> bend;
  if (rises) return no_contact;
  if (falls) {
    if (!(gap.at(a).gap > 0.0)) return a;
    return gap.at(b).gap > 0.0 ? no_contact : refined(gap, a, b);
  }
  // Shorter than rounding can tell: a passage that touches at most.
  if (depth == 0 || !(middle > a && middle < b)) return no_contact;
  const double first = first_fall(gap, a, middle, depth - 1);
  return first < no_contact ? first : first_fall(gap, middle, b, depth - 1);
}

/// Is the gap positive on [a, b] for certain?
bool clear(const Gap& gap, double a, double b, int depth) {
  const double h = 0.5 * (b - a), middle = a + h;
  const Gap::At m = gap.at(middle);
  if (!(m.gap > 0.0)) return false;
  if (m.gap - std::fabs(m.rate) * h - 0.5 * gap.curvature(m, h) * h * h > 0.0) return true;
  if (depth == 0 || !(middle > a && middle < b)) return false;
  return clear(gap, a, middle, depth - 1) && clear(gap, middle, b, depth - 1);
}

/// What bounds say of a pair whose omegas differ, so that most strides need not be looked at. Each
/// disc is |v/omega| away from its guiding centre, which rests; one without omega is its own centre
/// and goes straight on. The bounds leave room for the rounding of what they are made of and of the
/// gap itself, so that a stride that is left out is one in which no contact would have been found.
class Guides {
 public:
  Guides(const PairFlight& pair, double reach) : apart_(pair.separation) {
    const auto add = [this](Vector v, double omega, double side) {
      if (omega == 0.0) {
        velocity_ = side * v;
        return 0.0;
      }
      apart_ = apart_ + (side / omega) * geometry::right(v);
      return length(v) / std::fabs(omega);
    };
    const double first = add(pair.first, pair.first_omega, 1.0);
    const double second = add(pair.second, pair.second_omega, -1.0);
    const double size = length(pair.separation) + length(apart_) + first + second + reach;
    margin_ = 64.0 * geometry::unit_roundoff * size;
    near_ = reach + first + second + margin_;
    const double first_speed = length(pair.first), second_speed = length(pair.second);
    rounding_ = 4.0 * geometry::unit_roundoff * (first_speed + second_speed);
    const double omega = std::fabs(pair.first_omega), other = std::fabs(pair.second_omega);
    if (omega > other)
      find_period(omega, other, first, second_speed);
    else
      find_period(other, omega, second, first_speed);
  }

  /// When the centres are near enough for a contact, |apart + velocity t| <= near: from a time
  /// until another, or never.
  struct Interval {
    double from = 0.0, until = no_contact;
  };
  Interval near() const {
    const double v2 = dot(velocity_, velocity_), d2 = dot(apart_, apart_);
    const double gap = d2 - near_ * near_, b = dot(apart_, velocity_);
    if (!(v2 > 0.0)) return gap > 0.0 ? Interval{0.0, 0.0} : Interval{};
    // As in time_to_contact. `near` is larger than need be by more than the rounding of all this,
    // except for that of the last operations.
    const double speed = std::sqrt(v2), across = geometry::cross(apart_, velocity_);
    const double discriminant = (near_ * speed - across) * (near_ * speed + across);
    if (gap > 0.0 && (b >= 0.0 || discriminant <= 0.0)) return {0.0, 0.0};
    if (!(discriminant >= 0.0)) return {};  // no numbers
    const double root = std::sqrt(discriminant), late = (root - b) / v2;
    // Of the last operations: the root, the difference and the quotients err by a unit of rounding
    // each, gap by two; errors of b are times in which less than the margin is flown.
    const double rounding = 8.0 * geometry::unit_roundoff * (root + std::fabs(b)) / v2;
    return {gap > 0.0 ? std::max(gap / (root - b) - rounding, 0.0) : 0.0, late + rounding};
  }

  double period() const { return period_; }
  bool periodic() const { return drift_ == 0.0; }
  /// How much nearer than at a time in the period after t, as it is computed, the discs can be any
  /// number of whole periods later, until t + ahead.
  double shift(double t, double ahead) const { return drift_ * ahead + rounding_ * t + margin_; }
  /// After which the shift is more than any contact is away from any other.
  double longest() const { return 2.0 * near_ / drift_; }
  /// The contact of a disc on a line with one whose circle is too small to be seen.
  double with_centre(double reach) const { return time_to_contact(apart_, velocity_, 0.0, reach); }

 private:
  /// After a turn of the faster disc it is back, and the other has moved, by its speed times the
  /// time at most. Or, after some turns of the slower disc, that is back and the faster one is
  /// nearly: there is a shift by the part of a turn that is missing. Whichever drifts least.
  void find_period(double fast, double slow, double radius, double slow_speed) {
    constexpr double turn = 6.283185307179586;
    period_ = turn / fast;
    drift_ = slow_speed;
    for (double q = 1.0; q * fast <= 256.0 * slow && drift_ > 0.0; ++q) {
      const double whole = std::floor(q * (fast / slow) + 0.5);
      double missing = std::fabs(std::fma(q, fast / slow, -whole));
      // What is missing at a whole ratio of charges and masses is the rounding of both omegas and
      // of their quotient, three units. So little moves the faster disc by 3u of its way, and
      // phases omega t, rounded, are off by as much: `rounding_` counts 4u of both ways.
      constexpr double u = geometry::unit_roundoff;
      missing = missing <= 3.0 * u * whole ? 0.0 : missing + 2.0 * u * whole;
      const double period = q * (turn / slow), drift = turn * missing * radius / period;
      if (!(drift < drift_)) continue;
      period_ = period;
      drift_ = drift;
    }
  }

  Vector apart_, velocity_{};  ///< of the centres: first less second
  double near_ = 0.0, margin_ = 0.0, rounding_ = 0.0;
  double period_ = 0.0, drift_ = 0.0;
};

/// How long from t on there is certainly no contact: a period without one is followed by others,
/// until the drift has used up what was left between the discs in it.
double free_time(const PairFlight& pair, double reach, const Guides& guides, double t,
                 double until) {
  double ahead = std::min(until - t, guides.longest());
  for (; ahead > 8.0 * guides.period(); ahead *= 0.125) {
    const Gap wide(pair, reach + guides.shift(t, ahead));
    const double stride = wide.stride(), strides = std::ceil(guides.period() / stride) + 1.0;
    double i = 0.0;
    while (i < strides && clear(wide, t + i * stride, t + (i + 1.0) * stride, 12)) ++i;
    if (i == strides) return ahead;
  }
  return 0.0;
}

}  // namespace

double enclosed_time_to_contact(const PairFlight& pair, double reach, double until) {
  const Gap gap(pair, reach);
  const Gap::At start = gap.at(0.0);
  if (start.gap <= 0.0 && start.rate < 0.0) return 0.0;
  const double stride = gap.stride();
  for (double k = 0.0; k * stride < until; ++k) {
    const double t = first_fall(gap, k * stride, (k + 1.0) * stride, 60);
    if (t < no_contact) return t;
  }
  return no_contact;
}

double guided_time_to_contact(const PairFlight& pair, double reach, double until,
                              std::int64_t* strides) {
  const Gap gap(pair, reach);
  const Gap::At start = gap.at(0.0);
  if (start.gap <= 0.0 && start.rate < 0.0) return 0.0;
  if (!(dot(pair.first, pair.first) + dot(pair.second, pair.second) > 0.0)) return no_contact;
  const Guides guides(pair, reach);
  const Guides::Interval near = guides.near();
  until = std::min(until, near.until);
  const double stride = gap.stride(), round = guides.period() / stride;
  // The stride that holds a time, and one more for its rounding.
  const auto stride_at = [stride](double t) { return std::max(std::floor(t / stride) - 1.0, 0.0); };
  double k = stride_at(near.from), in_vain = 0.0;
  while (k * stride < until) {
    if (in_vain > round) {
      if (guides.periodic()) return no_contact;
      in_vain = 0.0;
      const double t = k * stride;
      k = std::max(k, stride_at(t + free_time(pair, reach, guides, t, until)));
    }
    if (strides != nullptr) ++*strides;
    const double a = k * stride, b = (k + 1.0) * stride;
    if (!(b > a))
      return std::max(guides.with_centre(reach), a);  // so many turns that their phase is none
    const double t = first_fall(gap, a, b, 60);
    if (t < no_contact) return t;
    ++k;
    ++in_vain;
  }
  return no_contact;
}

double time_to_contact(const PairFlight& pair, double reach, double until) {
  if (pair.first_omega == pair.second_omega)
    return time_to_contact(pair.separation, pair.first - pair.second, pair.first_omega, reach);
  return guided_time_to_contact(pair, reach, until);
}

ElasticContact elastic_contact(Vector d, Vector first, Vector second, double first_mass,
                               double second_mass) {
  const double mass = first_mass + second_mass;
  const double reduced = first_mass * (second_mass / mass);
  const double d2 = dot(d, d), length = std::sqrt(d2);
  const Vector v = first - second;
  const double along = dot(d, v), across = geometry::cross(d, v);
  ElasticContact c;
  c.transfer = 2.0 * reduced * std::fabs(along) / length;
  const auto push = [&](double size) {  // size: of the change of v along d, over |d|
    const Vector p = size * d;
    c.first = first - (second_mass / mass) * p;
    c.second = second + (first_mass / mass) * p;
  };
  if (first_mass == second_mass && std::fabs(across) <= std::fabs(along)) {
    // Each takes the other's velocity along the line of centres and keeps its own across it.
    const Vector t = (across / d2) * geometry::left(d);
    c.first = second + t;
    c.second = first - t;
  } else {
    push(2.0 * along / d2);
  }
  // A grazing contact whose change of velocity was rounded away: the smallest push that shows.
  double size = std::fabs(along) / d2;
  const double unit = geometry::unit_roundoff *
                      (std::sqrt(dot(first, first)) + std::sqrt(dot(second, second))) / length;
  for (double extra = unit; !(dot(d, c.first - c.second) > 0.0) && std::isfinite(extra);
       extra *= 2.0) {
    size = std::max(size, 0.0);
    push(-(2.0 * size + extra));
  }
  return c;
}

}  // namespace carom::motion
