#include "carom/certify/certified_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carom/base/error.hpp"
#include "certify/attempt.hpp"
#include "certify/followed_orbit.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/wall/system_check.hpp"
#include "table/bezier_wall.hpp"

namespace carom {

namespace {

using certify::BallState;
using certify::Outcome;

class WallOrbit final : public certify::FollowedOrbit {
 public:
  WallOrbit(const ExactSystem& system, const CertifiedTask& task, std::function<bool()> interrupted)
      : system_(system), task_(task), interrupted_(std::move(interrupted)) {
    check_field();
    certify::check_system(system_);
    // A first attempt of few bits sees the table and the start, and looks ahead.
    const certify::Attempt scout(system_, task_, ties_, 128, reading_bits_);
    effort_.rescaled = scout.rescaled();
    const certify::Forecast forecast = scout.look_ahead(interrupted_);
    reading_bits_ += static_cast<long>(std::ceil(scout.size_bits()));
    if (interrupted_ && interrupted_()) {  // the start, for the end
      restart(bits_of_digits());
      return;
    }
    hits_ = static_cast<double>(task_.collisions > 0 ? task_.collisions : forecast.hits);
    // Behind a hole that the orbit may miss it goes on as before.
    const double more = forecast.hits > 0 ? hits_ / static_cast<double>(forecast.hits) : 1.0;
    const double lost = forecast.bits * more + scout.rounding_loss(hits_);
    if (forecast.hits > 0) {
      const auto seen = static_cast<double>(forecast.hits);
      loss_a_hit_ = forecast.bits / seen;
      spread_a_hit_ = forecast.spread / std::sqrt(seen);
    }
    reading_bits_ =
        usual_reading_bits + static_cast<long>(std::ceil(scout.size_bits(forecast, more)));
    restart(static_cast<long>(lost + margin(forecast.spread * std::sqrt(more)) +
                              static_cast<double>(task_.digits) * 3.3219280948873626 + 3.0 +
                              scout.size_bits()));
  }

  std::optional<CertifiedHit> next() override {
    if (done_) return std::nullopt;
    for (;;) {
      if (task_.collisions > 0 && attempt_->hits() >= task_.collisions) {
        finish_with(CertifiedFate::completed, "");
        return std::nullopt;
      }
      if (interrupted_ && interrupted_()) {
        finish_as_given(CertifiedFate::interrupted, "");
        return std::nullopt;
      }
      const Outcome outcome = checked(attempt_->step());
      switch (outcome.kind) {
        case Outcome::hit: {
          list_ties(attempt_->hits(), Listed::all);
          if (attempt_->hits() <= given_) break;  // given out by an earlier attempt
          given_ = attempt_->hits();
          undecided_ = 0;
          CertifiedHit hit;
          certify::fill(hit, std::move(state_));
          hit.number = given_;
          hit.wall = attempt_->wall();
          hit.cell = attempt_->cell();
          last_ = hit;  // the end, should what follows not be enclosed
          if (given_ % 32 == 0 && hopeless())
            restart(effort_.bits +
                    std::max(still_needed({Outcome::inaccurate, -attempt_->spare_bits(), {}}), 4L));
          return hit;
        }
        case Outcome::inaccurate:
          if (!std::isfinite(outcome.missing_bits) &&
              (32L << undecided_) > task_.most_bits_a_doubt) {
            finish_as_given(CertifiedFate::undecided, "event " + std::to_string(attempt_->hits()) +
                                                          " is not enclosed by " +
                                                          std::to_string(effort_.bits) + " bits");
            return std::nullopt;
          }
          // The missing bits may be lost while the result is read, not along the orbit: raise the
          // reading precision as well.
          if (std::isfinite(outcome.missing_bits))
            lacked_ =
                std::min(2 * lacked_ + static_cast<long>(outcome.missing_bits) + 1, effort_.bits);
          restart(effort_.bits + std::max(still_needed(outcome), 4L) +
                  (std::isfinite(outcome.missing_bits) ? 0L : 32L << undecided_++));
          if (done_) return std::nullopt;
          break;
        case Outcome::undecided:
          if (!decide(outcome)) return std::nullopt;
          break;
        case Outcome::stopped:
          list_ties(attempt_->hits() + 1, Listed::touched);
          finish_with(CertifiedFate::completed, "");
          return std::nullopt;
        case Outcome::escaped:
          list_ties(attempt_->hits() + 1, Listed::all);
          finish_with(CertifiedFate::escaped, "");
          return std::nullopt;
        case Outcome::unbounded:
          check_domain();
          list_ties(attempt_->hits() + 1, Listed::touched);
          finish_with(turns_ ? CertifiedFate::pinned : CertifiedFate::unbounded, "");
          return std::nullopt;
        case Outcome::dead_end:
          finish_at_tie(ties_.joints.at(attempt_->hits() + 1).dead_end);
          return std::nullopt;
        case Outcome::too_far:
          if (outcome.doubt.first.wall < 0) {
            list_ties(attempt_->hits() + 1, Listed::touched);
            finish_with(CertifiedFate::undecided, "no wall within 10^5 lattice vectors");
            return std::nullopt;
          }
          if (!decide(outcome)) return std::nullopt;
          break;
      }
    }
  }

  const CertifiedEnd& end() const override { return end_; }
  const CertifiedEffort& effort() override {
    if (!done_ && attempt_) effort_.tangent_bits = attempt_->lost_bits();
    return effort_;
  }

 private:
  void check_field() {
    const certify::Precision precision(1024);
    const double speed = certify::value_of(system_.speed).to_double();
    if (!(speed > 1e-120 &&
          speed <
              1e120))  // beyond, squares leave the range of doubles, in which errors are followed
      throw InputError(system_.speed.place(), "a speed that certified orbits do not follow",
                       "a speed between 10^-120 and 10^120");
    const Sign turns = certify::sign(certify::value_of(system_.omega));
    turns_ = turns != Sign::zero;
    if (!turns_) return;
    if (turns == Sign::undecided)
      throw InputError(system_.omega.place(),
                       "the magnetic field cannot be distinguished from zero",
                       "0, or another number");
  }

  // A flight from inside a bounded table meets a wall, and a Larmor circle comes back to a wall
  // that it has left.
  void check_domain() const {
    const bool may_end = turns_ ? attempt_->hits() == 0 : system_.table->extent != Extent::bounded;
    if (!may_end)
      throw InternalError("a certified orbit has left its table after collision " +
                          std::to_string(attempt_->hits()));
  }

  // Bits beyond those that a forecast expects to be lost: two standard deviations of the forecast,
  // and of what its own roundings may miss. Too few mean that nearly all is flown again, too many
  // make each hit a little slower: an attempt of 2 sigma more bits costs a tenth more, a second one
  // twice as much.
  static double margin(double spread) { return 2.0 * std::sqrt(16.0 + spread * spread) + 4.0; }

  // Will the bits of this attempt probably not last? Giving it up must be likely to save time: its
  // hits must be flown again.
  bool hopeless() const {
    const auto flown = static_cast<double>(attempt_->hits());
    const double rest = hits_ - flown;
    if (!(rest > 0.0)) return false;
    const double expected = loss_a_hit_ * rest, spread = spread_a_hit_ * std::sqrt(rest);
    return attempt_->spare_bits() < expected - spread * hopeless_spreads;
  }

  // The bits that this attempt lacks now, and those that the rest of the orbit will lose. The
  // forecast starts here: the first one may have left through a hole that the orbit misses.
  long still_needed(const Outcome& outcome) const {
    const double lacks = std::isfinite(outcome.missing_bits) ? outcome.missing_bits : 64.0;
    const certify::Forecast forecast = attempt_->look_ahead(interrupted_);
    double rest = forecast.bits;
    const auto flown = static_cast<double>(attempt_->hits());
    const double lost = std::min(attempt_->lost_bits(), static_cast<double>(effort_.bits));
    if (task_.collisions > 0 && flown > 100.0) {
      const auto unseen = static_cast<double>(task_.collisions - forecast.hits) - flown;
      rest += std::max(0.0, unseen) * lost / flown;
    }
    return static_cast<long>(lacks + rest + margin(rest > 0.0 ? forecast.spread : 0.0)) + 1;
  }

  // Reports ties decided by rational arithmetic up to this event; if the orbit ends earlier, only
  // tangencies before the end.
  enum class Listed : unsigned char { all, touched };
  void list_ties(std::uint64_t event, Listed listed) {
    for (const WaitingTie& tie : waiting_) {
      const bool tangency = tie.touched.wall >= 0;
      if (tie.event > event || (listed == Listed::touched && !tangency)) continue;
      if (!tangency || !attempt_->lies_behind(tie.touched)) end_.ties.push_back(tie.text);
    }
    std::erase_if(waiting_, [&](const WaitingTie& tie) { return tie.event <= event; });
  }

  // First more bits, then rational numbers, then many more bits. False: the orbit has ended.
  bool decide(const Outcome& outcome) {
    const std::uint64_t event = attempt_->hits() + 1;
    const auto joint = ties_.joints.find(event);  // what is in doubt may be what comes before it
    const bool known = joint != ties_.joints.end() &&
                       outcome.doubt.kind == certify::Doubt::choice &&
                       outcome.doubt.first == joint->second.hit;
    if (!known && (undecided_ == 1 || ties_found_ > 0)) {  // one tie is seldom alone
      if (const auto tie = tie_at(outcome)) {
        if (!tie->goes_on() && tie->at &&
            joint == ties_.joints.end()) {  // if no other wall comes before
          ties_.joints[event] = {tie->joint.front(), tie->joint, *tie->at, tie->text};
          undecided_ = 0;
          return true;
        }
        // Along the edge of a corridor discs are touched without end: on one flight that meets
        // nothing else, or on many.
        const bool again = outcome.kind == Outcome::too_far &&
                           tie->kind == certify::Tie::tangency && ties_.passed_by.count(event) > 0;
        if (!tie->goes_on() || again || ties_found_ >= 1000) {
          finish_at_tie(tie->text);
          return false;
        }
        ++ties_found_;
        waiting_.push_back(
            {event, tie->text,
             tie->kind == certify::Tie::tangency ? tie->walls.front() : certify::Copy{}});
        if (tie->kind == certify::Tie::tangency)
          ties_.passed_by[event].push_back(tie->walls.front());
        if (tie->kind == certify::Tie::reflection) {
          for (std::size_t i = 0; i < tie->walls.size(); ++i)
            ties_.joints[event + i] = {tie->walls[i],
                                       i == 0 ? tie->joint : std::vector<certify::Copy>(),
                                       i == 0 ? *tie->at : certify::WallEnd(), ""};
          if (tie->beside >= 0)
            ties_.passed_by[event + tie->walls.size()].push_back({tie->beside, {}});
        }
        if (tie->kind == certify::Tie::last_time) ties_.at_last_time = event;
        if (tie->kind == certify::Tie::hole_start) ties_.holes[event] = tie->hole;
        if (tie->kind == certify::Tie::hole_end) ties_.holes[event] = -1;
        undecided_ = 0;
        return true;  // the attempt goes on from before the event
      }
    }
    const long more = 32L << undecided_++;
    if (more > task_.most_bits_a_doubt) {
      finish_with(CertifiedFate::undecided, attempt_->description(outcome.doubt) +
                                                "; not decided by " + std::to_string(effort_.bits) +
                                                " bits");
      return false;
    }
    restart(effort_.bits + std::max(still_needed(outcome), 0L) + more);
    return !done_;
  }

  std::optional<certify::Tie> tie_at(const Outcome& outcome) {
    std::vector<certify::Copy> walls = attempt_->path();
    if (walls.size() < attempt_->hits() || outcome.doubt.first.wall < 0) return std::nullopt;
    walls.resize(attempt_->hits());  // those before the event in doubt
    return tie_finder_.find(walls, outcome.doubt);
  }

  long bits_of_digits() const {
    return static_cast<long>(static_cast<double>(task_.digits) * 3.33) + 64;
  }

  void restart(long bits) {
    if (bits > task_.most_bits) {
      finish_as_given(CertifiedFate::undecided,
                      "the requested digits need " + std::to_string(bits) + " bits");
      return;
    }
    effort_.bits = bits;
    ++effort_.attempts;
    attempt_.emplace(system_, task_, ties_, bits, reading_bits_ + lacked_);
  }

  // Asks for more bits where the numbers that are given out, translated by their cell and rounded,
  // would not be accurate.
  Outcome checked(Outcome outcome) {
    const bool ends = outcome.kind == Outcome::stopped || outcome.kind == Outcome::escaped;
    if (!ends && (outcome.kind != Outcome::hit || attempt_->hits() <= given_)) return outcome;
    state_ = attempt_->enclosed();
    const double missing = attempt_->missing_bits(state_);
    return missing <= 0.0 ? outcome : Outcome{Outcome::inaccurate, missing, {}};
  }

  void finish_at_tie(const std::string& text) {
    list_ties(attempt_->hits() + 1, Listed::all);
    finish_with(CertifiedFate::singular, text);
  }

  void finish_with(CertifiedFate fate, std::string reason) {
    BallState s = attempt_->enclosed();
    if (!(attempt_->missing_bits(s) <= 0.0)) {
      finish_as_given(fate, std::move(reason));
      return;
    }
    finish(fate, std::move(reason));
    end_.collisions = attempt_->hits();
    end_.wall = attempt_->wall();
    end_.hole = attempt_->hole();
    end_.cell = attempt_->cell();
    certify::fill(end_, std::move(s));
  }

  // With the last hit that was given out: the present attempt may not have come back to it, or not
  // be accurate where it is.
  void finish_as_given(CertifiedFate fate, std::string reason) {
    finish(fate, std::move(reason));
    if (given_ > 0) {
      static_cast<CertifiedState&>(end_) = last_;
      end_.collisions = given_;
      end_.wall = last_.wall;
      end_.cell = last_.cell;
      return;
    }
    for (long bits = bits_of_digits();; bits *= 2) {  // the end is the start
      attempt_.emplace(system_, task_, ties_, bits, bits);
      BallState s = attempt_->enclosed();
      const bool accurate = attempt_->missing_bits(s) <= 0.0;
      if (!accurate && bits < task_.most_bits) continue;
      end_.wall = attempt_->wall();
      certify::fill(end_, std::move(s));
      return;
    }
  }

  void finish(CertifiedFate fate, std::string reason) {
    done_ = true;
    end_.fate = fate;
    end_.reason = std::move(reason);
    if (attempt_) effort_.tangent_bits = attempt_->lost_bits();
  }

  const ExactSystem system_;
  const CertifiedTask task_;
  const std::function<bool()> interrupted_;
  certify::KnownTies ties_;
  certify::TieFinder tie_finder_{system_, task_};
  /// Is listed once the orbit has gone through it: it may end before.
  struct WaitingTie {
    std::uint64_t event;
    std::string text;
    certify::Copy touched;  ///< of a tangency
  };
  std::vector<WaitingTie> waiting_;
  int ties_found_ = 0;
  double hits_ = 0.0;  ///< expected
  double loss_a_hit_ = 0.0,
         spread_a_hit_ = 0.0;  ///< by the first forecast, bits; of n hits sqrt(n) times the latter
  static constexpr double hopeless_spreads = 1.0;
  std::optional<certify::Attempt> attempt_;
  std::uint64_t given_ = 0;
  CertifiedHit last_;  ///< that was given out
  BallState state_;    ///< to be given out
  int undecided_ = 0;
  static constexpr long usual_reading_bits = 96;
  long reading_bits_ = usual_reading_bits;  ///< Attempt's, by the sizes that are expected
  long lacked_ = 0;                         ///< more of them, by what attempts have lacked
  bool turns_ = false;                      ///< in a magnetic field
  bool done_ = false;
  CertifiedEnd end_;
  CertifiedEffort effort_;
};

}  // namespace

CertifiedOrbit::CertifiedOrbit(const ExactSystem& system, const CertifiedTask& task,
                               std::function<bool()> interrupted) {
  if (system.table) refuse_all_but_mirrors(*system.table, "guaranteed digits");
  if (task.collisions == 0 && !task.t_max)
    throw InputError(Place{}, "a certified orbit without an end",
                     "a number of collisions or a last time");
  check_digits(static_cast<std::uint64_t>(std::max(task.digits, 0)), *system.table);
  if (table::bezier_wall(*system.table) && !system.table->lattice)
    implementation_ = certify::orbit_among_curves(system, task, std::move(interrupted));
  else
    implementation_ = std::make_unique<WallOrbit>(system, task, std::move(interrupted));
}
CertifiedOrbit::~CertifiedOrbit() = default;
CertifiedOrbit::CertifiedOrbit(CertifiedOrbit&&) noexcept = default;
std::optional<CertifiedHit> CertifiedOrbit::next() { return implementation_->next(); }
const CertifiedEnd& CertifiedOrbit::finish() {
  while (next()) {
  }
  return end_state();
}
const CertifiedEnd& CertifiedOrbit::end_state() const { return implementation_->end(); }
const CertifiedEffort& CertifiedOrbit::effort() const { return implementation_->effort(); }

CertifiedOrbit certified_orbit(const ExactSystem& system, std::uint64_t collisions, int digits) {
  CertifiedTask task;
  task.collisions = collisions;
  task.digits = digits;
  return CertifiedOrbit(system, task);
}

CertifiedOrbit certified_orbit(const TableSpec& spec, const ExactStart& start,
                               std::uint64_t collisions, int digits) {
  ExactSystem system;
  system.spec = std::make_shared<const TableSpec>(spec);
  system.table = std::make_shared<const Table>(build_table(spec));
  system.start = start;
  return certified_orbit(system, collisions, digits);
}

}  // namespace carom
