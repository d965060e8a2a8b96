// Certified orbits inside a curve that was written as formulas.
//
// A hit is known by the curve's parameter. Doubles find about where the next one is; Newton's steps
// and one with balls enclose the zero of the flight's distance from the curve, and beside_curve.hpp
// proves that it comes first. Where balls cannot tell, or are too wide for the digits, the orbit is
// followed again from its exact start with more bits.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <variant>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "certify/flight/beside_curve.hpp"
#include "certify/followed_orbit.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/wall/system_check.hpp"

namespace carom::certify {
namespace {

constexpr double bits_a_digit = 3.3219280948873626;  // log2(10)

class CurveOrbit final : public FollowedOrbit {
 public:
  CurveOrbit(const ExactSystem& system, const CertifiedTask& task,
             std::function<bool()> interrupted, CurveOfFormulas curve)
      : system_(system),
        task_(task),
        interrupted_(std::move(interrupted)),
        curve_(std::move(curve)) {
    check();
    const double hits = task_.collisions > 0 ? static_cast<double>(task_.collisions) : 16.0;
    restart(std::min(static_cast<double>(task_.digits) * bits_a_digit + 64.0 + 4.0 * hits,
                     static_cast<double>(task_.most_bits)));
  }

  std::optional<CertifiedHit> next() override {
    while (!done_) {
      if (task_.collisions > 0 && hits_ >= task_.collisions) {
        finish(CertifiedFate::completed, "");
        break;
      }
      if (interrupted_ && interrupted_()) {
        finish_as_given(CertifiedFate::interrupted, "");
        break;
      }
      const Precision precision(bits_);
      const Step step = take_step();
      if ((step == Step::stopped || step == Step::pinned) && is_accurate()) {
        finish(step == Step::pinned ? CertifiedFate::pinned : CertifiedFate::completed, "");
        break;
      }
      if (step != Step::hit || !(hits_ <= given_ || is_accurate())) {
        ask_for_more(step);
        continue;
      }
      if (hits_ <= given_) continue;  // given out by an earlier attempt
      given_ = hits_;
      CertifiedHit hit;
      fill(hit, state());
      hit.number = given_;
      hit.wall = wall_;
      last_ = hit;
      return hit;
    }
    return std::nullopt;
  }
  const CertifiedEnd& end() const override { return end_; }
  const CertifiedEffort& effort() override { return effort_; }

 private:
  enum class Step : unsigned char { hit, stopped, pinned, unclear };

  void check() {
    if (!system_.table->holes.empty())
      throw InputError(Place{},
                       "orbits inside a curve given by formulas are certified without holes",
                       "--closed");
    check_velocity(system_.start);
    if (system_.start.wall < 0) check_inside();
  }
  void check_inside() {
    const ExactPoint& at = system_.start.position;
    const Precision precision(bits_of_a_first_look);
    const std::optional<int> turns = turns_round(curve_, {value_of(at.x), value_of(at.y)});
    if (turns && *turns != 0) return;
    throw InputError(at.x.place(),
                     "the start (" + at.x.text() + ", " + at.y.text() + ") is " +
                         (turns ? "not inside the table" : "on the wall, or too near to it"),
                     "a point inside, off the walls");
  }

  void restart(double bits) {
    bits_ = static_cast<slong>(bits);
    if (bits_ > task_.most_bits)
      return finish_as_given(CertifiedFate::undecided,
                             "the requested digits need " + std::to_string(bits_) + " bits");
    ++effort_.attempts;
    effort_.bits = bits_;
    hits_ = 0;
    const Precision precision(bits_);
    const ExactStart& start = system_.start;
    time_ = Ball(0);
    wall_ = start.wall;
    u_ = start.u;
    speed_ = value_of(system_.speed);
    curvature_ = value_of(system_.omega) / speed_;
    direction_ = {value_of(start.direction.x), value_of(start.direction.y)};
    if (start.angle) {
      const CosSin d = direction_of(*start.angle);
      direction_ = {d.cos, d.sin};
    } else {
      const Ball length2 = dot(direction_, direction_);
      effort_.rescaled = !(length2 - square(speed_)).contains(Ball(0));
      direction_ = (Ball(1) / sqrt(length2)) * direction_;
    }
    parameter_.reset();
    if (wall_ < 0) {
      position_ = {value_of(start.position.x), value_of(start.position.y)};
      return;
    }
    parameter_ = Ball(curve_.parameter(wall_, u_));
    const CurvePlace place = curve_.at(*parameter_);
    position_ = place.point;
    if (inwards(place.first) == Sign::negative)
      throw InputError(Place{}, "the velocity does not point into the domain");
  }

  Sign inwards(const BallVector& tangent) const {
    return sign(Ball(curve_.turn()) * cross(tangent, direction_));
  }
  BallState state() const { return {position_, speed_ * direction_, time_}; }

  /// log2 of the largest error of the state's numbers.
  double log2_error() const {
    const BallState s = state();
    double worst = s.time.radius().log2();
    for (const BallVector* v : {&s.position, &s.velocity})
      worst = std::max({worst, v->x.radius().log2(), v->y.radius().log2()});
    return worst;
  }
  double wanted() const { return -static_cast<double>(task_.digits) * bits_a_digit - 1.0; }
  bool is_accurate() {
    const double error = log2_error();
    effort_.tangent_bits = std::max(0.0, error + static_cast<double>(bits_));
    return error < wanted();
  }

  /// By what has been lost so far, and will be along the rest.
  void ask_for_more(Step step) {
    const double bits = static_cast<double>(bits_), flown = static_cast<double>(hits_);
    double more = 0.3 * bits + 64.0;
    if (flown > 8.0 && task_.collisions > 0)
      more = std::max(more, effort_.tangent_bits / flown * static_cast<double>(task_.collisions) +
                                64.0 - wanted() - bits);
    if (step == Step::unclear && log2_error() < -1.5 * static_cast<double>(task_.most_bits_a_doubt))
      return finish_as_given(CertifiedFate::undecided, "collision " + std::to_string(hits_ + 1) +
                                                           " is not decided by " +
                                                           std::to_string(bits_) + " bits");
    restart(bits + more);
  }

  Step take_step() {
    const std::optional<Bracket> about = near_next_hit();
    if (!about) {
      const bool turns = sign(curvature_) != Sign::zero && hits_ == 0 && !parameter_;
      const bool pinned =
          turns && circle_meets_nothing(curve_, {position_, position_, direction_, curvature_});
      return pinned ? Step::pinned : Step::unclear;
    }
    const auto side = [&](const CurvePlace& p) {
      return side_of_flight(direction_, curvature_, p.point - position_);
    };
    const auto slope = [&](const CurvePlace& p) {
      return slope_of_side(direction_, curvature_, p.point - position_, p.first);
    };
    Ball at(refined(*about, side, slope));
    for (double b = 30.0; b < 2.0 * static_cast<double>(bits_); b *= 2.0) {
      const CurvePlace place = curve_.at(at);
      at = (at - side(place) / slope(place)).midpoint();
    }
    const CurvePlace there = curve_.at(at);
    const Ball missed = side(there);
    Bound radius = size_of(missed / slope(there)) * Bound(2.0);
    for (int attempt = 0; attempt < 4; ++attempt, radius = radius * Bound(16.0)) {
      const Ball box = at.widened(radius);
      const CurvePlace about_there = curve_.at(box);
      const Ball hit = at - missed / slope(about_there);
      if (!box.contains(hit)) continue;
      // By their derivatives: formulas of balls are wider.
      const Ball e = hit - at;
      return arrive(hit, there.point + e * about_there.first, there.first + e * about_there.second);
    }
    return Step::unclear;
  }

  Step arrive(const Ball& hit, const BallVector& point, const BallVector& tangent) {
    const BallVector chord = point - position_;
    // An arc turns by as much before the middle of its chord as after it.
    const Ball length2 = dot(chord, chord), along = dot(direction_, chord);
    const BallVector arrival = ((Ball(2) * along) / length2) * chord - direction_;
    const FlightBetween flight{position_, point, direction_, curvature_};
    if (sign(Ball(curve_.turn()) * cross(tangent, arrival)) != Sign::negative ||
        (sign(curvature_) == Sign::zero && sign(along) != Sign::positive) ||
        !meets_nowhere_else(curve_, flight, parameter_, hit))
      return Step::unclear;
    const Ball time = time_ + length_of_flight(chord) / speed_;
    if (task_.t_max) {
      const Ball last = value_of(*task_.t_max), rest = last - time_;
      const Sign later = sign(time - last);
      if (later == Sign::undecided) return Step::unclear;
      if (later == Sign::positive) {
        fly(rest * speed_);
        time_ = last;
        return Step::stopped;
      }
    }
    const BallVector normal = left(tangent);
    const Ball twice = (Ball(2) * dot(arrival, normal)) / dot(normal, normal);
    direction_ = arrival - twice * normal;
    position_ = point;
    parameter_ = hit;
    time_ = time;
    std::tie(wall_, u_) = curve_.wall_at(hit.to_double());
    ++hits_;
    return Step::hit;
  }
  /// Twice the angle from the direction to the chord, over the curvature.
  Ball length_of_flight(const BallVector& chord) const {
    if (sign(curvature_) == Sign::zero) return sqrt(dot(chord, chord));
    Ball half_turn;
    arb_atan2(half_turn.raw(), cross(chord, direction_).raw(), dot(chord, direction_).raw(),
              Precision::bits());
    return Ball(2) * half_turn / curvature_;
  }
  /// Over a way of that length.
  void fly(const Ball& length) {
    if (sign(curvature_) == Sign::zero) {
      position_ = position_ + length * direction_;
      return;
    }
    Ball sine, cosine;
    arb_sin_cos(sine.raw(), cosine.raw(), (curvature_ * length).raw(), Precision::bits());
    const BallVector right = -left(direction_);
    position_ =
        position_ + (sine / curvature_) * direction_ + ((Ball(1) - cosine) / curvature_) * right;
    direction_ = cosine * direction_ + sine * right;
  }

  /// About where the next hit is: between two parameters, at which the flight passes on either
  /// side of the curve's point.
  struct Bracket {
    double before, after, about;
  };
  /// The parameter there, by Newton's steps in doubles that do not leave the bracket. It is where
  /// the search with balls begins, so that how near it comes decides nothing.
  double refined(const Bracket& bracket, const auto& side, const auto& slope) const {
    const Precision precision(64);
    double before = bracket.before, after = bracket.after, t = bracket.about;
    for (int n = 0; n < 100; ++n) {
      const CurvePlace place = curve_.at(Ball(t));
      const double value = side(place).to_double();
      (value < 0.0 ? before : after) = t;
      double next = t - value / slope(place).to_double();
      const bool within =
          before < after ? before < next && next < after : after < next && next < before;
      if (!within) next = before + 0.5 * (after - before);
      const bool done = std::fabs(next - t) <= 0x1p-45 * std::fabs(curve_.length().to_double());
      t = next;
      if (done) break;
    }
    return t;
  }
  /// Where the flight first leaves the polygon of the points between pieces, in doubles.
  std::optional<Bracket> near_next_hit() const {
    const geometry::Vector P = in_doubles(position_), d = in_doubles(direction_);
    const double k = curvature_.to_double();
    double first = HUGE_VAL;
    std::optional<Bracket> found;
    // By half of the angle that the flight has turned by, or by its length.
    const auto offer = [&](int wall, double u, double low, double high, geometry::Vector e) {
      const double along = dot(d, e);
      const double way =
          k == 0.0 ? along : elementary::atan2(std::copysign(1.0, k) * cross(e, d), along);
      if (!(way > 0.0 && way < first)) return;
      first = way;
      found = {curve_.parameter(wall, low), curve_.parameter(wall, high),
               curve_.parameter(wall, u)};
    };
    for (int wall = 0; wall < static_cast<int>(system_.table->walls.size()); ++wall) {
      const geometry::Curve& curve = system_.table->wall(wall).curve;
      const geometry::Vector from = geometry::start_point(curve) - P,
                             side = geometry::end_point(curve) - geometry::start_point(curve);
      // The side of the flight is a w^2 + b w + c on the way from one point to the next.
      const double a = k * dot(side, side), c = geometry::side_of_flight(d, from, k),
                   b = 2.0 * (cross(d, side) + k * dot(from, side));
      if (wall == wall_) {
        along_piece(c, a + b + c, from, side, offer);
        continue;
      }
      // From between the curve and its chord: this comes before all others.
      const double height = cross(side, -from), share = dot(side, -from) / dot(side, side);
      if (height < 0.0 && share > 0.0 && share < 1.0 && cross(side, d) < 0.0 &&
          height * height < dot(side, side) * bulge_of(curve))
        offer(wall, share, 0.0, 1.0, 0x1p-100 * d);
      const double square = b * b - 4.0 * a * c;
      if (!(square > 0.0)) continue;
      // Where it rises.
      const double root = std::sqrt(square),
                   u = b > 0.0 ? -2.0 * c / (b + root) : (root - b) / (2.0 * a);
      if (u >= 0.0 && u < 1.0) offer(wall, u, 0.0, 1.0, from + u * side);
    }
    return found;
  }
  /// The square of how far the control points are from the chord, at most.
  static double bulge_of(const geometry::Curve& curve) {
    const auto& bezier = std::get<geometry::Bezier>(curve);
    const geometry::Vector side = bezier.to - bezier.from;
    double most = 0.0;
    for (int i = 1; i < bezier.degree; ++i) {
      const double height = cross(side, bezier.control(i) - bezier.from);
      most = std::max(most, height * height / dot(side, side));
    }
    return most;
  }
  /// The piece that the flight comes from bends back into it if one of its ends is on the other
  /// side. With the slope a at the start the side is about -a s + b s^2.
  void along_piece(double at_start, double at_end, geometry::Vector from, geometry::Vector side,
                   const auto& offer) const {
    const double part = curve_.parameter(wall_, 1.0) - curve_.parameter(wall_, 0.0);
    const geometry::Vector tangent = in_doubles(curve_.at(*parameter_).first);
    const double a = -2.0 * part * cross(in_doubles(direction_), tangent);
    for (const auto& [length, value] : {std::pair{1.0 - u_, at_end}, std::pair{-u_, -at_start}}) {
      if (!(value > 0.0)) continue;
      const double end = length > 0.0 ? value : -value;
      const double u = u_ + a * length * length / (end + a * length);
      // Half-way from the start to the root the side has the sign that it has beside the start.
      const double half = u_ + 0.5 * (u - u_);
      offer(wall_, u, length > 0.0 ? half : 0.0, length > 0.0 ? 1.0 : half, from + u * side);
    }
  }

  void finish(CertifiedFate fate, std::string reason) {
    const Precision precision(bits_);
    done_ = true;
    end_.fate = fate;
    end_.reason = std::move(reason);
    end_.collisions = hits_;
    end_.wall = wall_;
    fill(end_, state());
  }
  /// With the last hit that was given out, or the start.
  void finish_as_given(CertifiedFate fate, std::string reason) {
    if (given_ == 0) return finish(fate, std::move(reason));
    done_ = true;
    end_.fate = fate;
    end_.reason = std::move(reason);
    static_cast<CertifiedState&>(end_) = last_;
    end_.collisions = given_;
    end_.wall = last_.wall;
  }

  const ExactSystem system_;
  const CertifiedTask task_;
  const std::function<bool()> interrupted_;
  const CurveOfFormulas curve_;
  slong bits_ = 0;
  // After the last hit.
  BallVector position_, direction_;
  Ball time_, speed_, curvature_;
  std::optional<Ball> parameter_;  ///< where it is on the curve
  int wall_ = -1;
  double u_ = 0.0;
  std::uint64_t hits_ = 0, given_ = 0;
  CertifiedHit last_;
  bool done_ = false;
  CertifiedEnd end_;
  CertifiedEffort effort_;
};

}  // namespace

std::unique_ptr<FollowedOrbit> orbit_along_curve(const ExactSystem& system,
                                                 const CertifiedTask& task,
                                                 std::function<bool()> interrupted,
                                                 CurveOfFormulas curve) {
  return std::make_unique<CurveOrbit>(system, task, std::move(interrupted), std::move(curve));
}

}  // namespace carom::certify
