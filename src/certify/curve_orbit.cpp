// Certified orbits among curves.
//
// A hit is known by its piece's parameter. Boxes find about where the next one is; Newton's steps
// and one with balls enclose the zero of the flight's distance from the piece, and beside_curve.hpp
// proves that it comes first. Where balls cannot tell, or are too wide for the digits, the orbit is
// followed again from its exact start with more bits.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "carom/base/error.hpp"
#include "certify/flight/beside_curve.hpp"
#include "certify/followed_orbit.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/wall/holes_of_pieces.hpp"
#include "certify/wall/system_check.hpp"

namespace carom::certify {
namespace {

constexpr double bits_a_digit = 3.3219280948873626;  // log2(10)

class CurveOrbit final : public FollowedOrbit {
 public:
  CurveOrbit(const ExactSystem& system, const CertifiedTask& task,
             std::function<bool()> interrupted)
      : system_(system),
        task_(task),
        interrupted_(std::move(interrupted)),
        shape_(table::shapes::written_shape(*system.spec)) {
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
      if (step == Step::ended && is_accurate()) {
        finish(fate_, "");
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
  enum class Step : unsigned char { hit, ended, unclear };

  void check() {
    check_velocity(system_.start);
    if (system_.start.wall < 0) check_inside();
  }
  void check_inside() {
    const ExactPoint& at = system_.start.position;
    const Precision precision(bits_of_a_first_look);
    const std::optional<int> turns =
        turns_round(Pieces(*system_.spec, shape_), {value_of(at.x), value_of(at.y)});
    if (turns && *turns == (system_.table->extent == Extent::bounded ? 1 : 0)) return;
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
    holes_.reset();
    pieces_.emplace(*system_.spec, shape_);
    holes_.emplace(system_, *pieces_);
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
    spot_.reset();
    if (wall_ < 0) {
      position_ = {value_of(start.position.x), value_of(start.position.y)};
      return;
    }
    spot_ = pieces_->spot(wall_, u_);
    const Piece& piece = (*pieces_)[spot_->piece];
    const CurvePlace place = piece.at(spot_->t);
    position_ = place.point;
    if (sign(Ball(piece.turn) * cross(place.first, direction_)) == Sign::negative)
      throw InputError(Place{}, "the velocity does not point into the domain");
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
    const FlightBetween ahead{position_, {}, direction_, curvature_};
    const std::optional<Pieces::Spot> about = first_exit(*pieces_, ahead);
    if (!about) {
      const bool turns = sign(curvature_) != Sign::zero;
      const bool may_end = turns ? !spot_ : system_.table->extent != Extent::bounded;
      if (!may_end || !meets_nowhere_else(*pieces_, ahead, spot_, {})) return Step::unclear;
      return end_as(turns ? CertifiedFate::pinned : CertifiedFate::unbounded);
    }
    const Piece& piece = (*pieces_)[about->piece];
    const auto side = [&](const CurvePlace& p) {
      return side_of_flight(direction_, curvature_, p.point - position_);
    };
    const auto slope = [&](const CurvePlace& p) {
      return slope_of_side(direction_, curvature_, p.point - position_, p.first);
    };
    Ball at = about->t;
    for (double b = 30.0; b < 2.0 * static_cast<double>(bits_); b *= 2.0) {
      const CurvePlace place = piece.at(at);
      at = (at - side(place) / slope(place)).midpoint();
    }
    const CurvePlace there = piece.at(at);
    const Ball missed = side(there);
    Bound radius = size_of(missed / slope(there)) * Bound(2.0);
    for (int attempt = 0; attempt < 4; ++attempt, radius = radius * Bound(16.0)) {
      const Ball box = at.widened(radius);
      const CurvePlace about_there = piece.at(box);
      const Ball hit = at - missed / slope(about_there);
      if (!box.contains(hit)) continue;
      // By their derivatives: formulas of balls are wider.
      const Ball e = hit - at;
      return arrive({about->piece, hit}, there.point + e * about_there.first,
                    there.first + e * about_there.second);
    }
    return Step::unclear;
  }

  Step end_as(CertifiedFate fate) {
    fate_ = fate;
    return Step::ended;
  }
  Step arrive(const Pieces::Spot& hit, const BallVector& point, const BallVector& tangent) {
    const BallVector chord = point - position_;
    // An arc turns by as much before the middle of its chord as after it.
    const Ball length2 = dot(chord, chord), along = dot(direction_, chord);
    const BallVector arrival = ((Ball(2) * along) / length2) * chord - direction_;
    const FlightBetween flight{position_, point, direction_, curvature_};
    if (sign(Ball((*pieces_)[hit.piece].turn) * cross(tangent, arrival)) != Sign::negative ||
        (sign(curvature_) == Sign::zero && sign(along) != Sign::positive) ||
        !meets_nowhere_else(*pieces_, flight, spot_, hit))
      return Step::unclear;
    const Ball time = time_ + length_of_flight(chord) / speed_;
    if (task_.t_max) {
      const Ball last = value_of(*task_.t_max), rest = last - time_;
      const Sign later = sign(time - last);
      if (later == Sign::undecided) return Step::unclear;
      if (later == Sign::positive) {
        fly(rest * speed_);
        time_ = last;
        return end_as(CertifiedFate::completed);
      }
    }
    const Passage passage = holes_->passage(hit);
    if (passage.verdict == Verdict::undecided) return Step::unclear;
    position_ = point;
    time_ = time;
    if (passage.verdict == Verdict::yes) {
      direction_ = arrival;
      end_.hole = passage.hole;
      return end_as(CertifiedFate::escaped);
    }
    const BallVector normal = left(tangent);
    const Ball twice = (Ball(2) * dot(arrival, normal)) / dot(normal, normal);
    direction_ = arrival - twice * normal;
    spot_ = hit;
    std::tie(wall_, u_) = pieces_->wall_at(hit);
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
  const table::shapes::Shape shape_;
  std::optional<Pieces> pieces_;
  std::optional<HolesOfPieces> holes_;
  slong bits_ = 0;
  // After the last hit.
  BallVector position_, direction_;
  Ball time_, speed_, curvature_;
  std::optional<Pieces::Spot> spot_;  ///< where it is on a wall
  int wall_ = -1;
  double u_ = 0.0;
  std::uint64_t hits_ = 0, given_ = 0;
  CertifiedHit last_;
  CertifiedFate fate_{};  ///< of a step that ends it
  bool done_ = false;
  CertifiedEnd end_;
  CertifiedEffort effort_;
};

}  // namespace

std::unique_ptr<FollowedOrbit> orbit_among_curves(const ExactSystem& system,
                                                  const CertifiedTask& task,
                                                  std::function<bool()> interrupted) {
  return std::make_unique<CurveOrbit>(system, task, std::move(interrupted));
}

}  // namespace carom::certify
