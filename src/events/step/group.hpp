// Particles that are integrated together: one that a potential acts on, or several that interact.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/interrupt.hpp"
#include "carom/base/time.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/events/surface.hpp"
#include "carom/forces/force_field.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/integrators/plan.hpp"
#include "carom/integrators/stepper.hpp"
#include "carom/motion/state.hpp"
#include "events/step/barrier.hpp"
#include "events/step/crossing_in_step.hpp"
#include "events/step/step_path.hpp"
#include "forces/force_bound.hpp"
#include "forces/resolution.hpp"

namespace carom::events {

/// Steps end at the multiples of the plan's step: where a step ends depends on the clock alone, not
/// on what happened before. An event within a step ends it there, and the rest of it is a step of
/// its own. Where the plan lets steps be halved, one that fails is taken in parts, which end at the
/// multiples of its half, quarter, ...: the longest part that does not fail. After each part the
/// rest of the step is tried as a whole again, so that the state and the clock alone choose parts.
class Group final : public ForceLaw<double> {
 public:
  /// What the group lives in; shared by all groups of a world, which it must outlive.
  struct Surroundings {
    base::Interrupt* interrupt = nullptr;  ///< of the run under way; null: nothing interrupts it
    const ForceField* forces = nullptr;    ///< null: nothing acts
    IntegratorPlan plan;
    const geometry::Lattice* lattice = nullptr;
    geometry::Vector centre;                ///< of the lattice's cell
    std::vector<Barrier<double>> barriers;  ///< walls and edges of supports, with their copies
    std::vector<Barrier<double>> supports;  ///< the latter alone: their inside is positive
    double longest_way =
        std::numeric_limits<double>::infinity();  ///< most that walls allow in one step
    std::shared_ptr<forces::ForceMaps> maps;  ///< bounds of external forces; null: any step will do
    std::function<bool(geometry::Vector)>
        inside;  ///< of a bounded table, or on its wall to rounding; empty: of another
    StepCounts* counts = nullptr;  ///< where steps and evaluations are counted, or null
    bool remember_energy = false;  ///< of the latest evaluation of the external forces
  };
  /// What comes first.
  struct Next {
    double duration = 0.0;
    int member = -1;  ///< -1: the end of the step
    const Barrier<double>* barrier = nullptr;
    bool unresolved = false;  ///< the step does not resolve the forces, and is taken all the same
    bool slides = false;      ///< indistinguishable from motion along that wall
    std::string fault;        ///< why there is no path that walls can be found on; "": there is
    int outside = -1;  ///< then: this member alone has left the table; -1: it is the fault of all
    bool in_parts = false;  ///< it ends a part of a step alone, and the step goes on
  };

  explicit Group(const Surroundings& in) : in_(in) {}
  /// Becomes a group of these bodies, whose states are still to be set.
  void assign(std::vector<int> bodies, std::vector<Particle> particles);

  const std::vector<int>& bodies() const { return bodies_; }
  const Phase<double>& phase() const { return phase_; }
  /// The state of a member after the group's last event: on a wall if it hit one then, or came so.
  State state(std::size_t member) const {
    const Place& at = places_[member];
    return {at.wall, at.u, phase_.position[member], phase_.velocity[member], at.cell, time_};
  }
  /// All but the time, which members have in common.
  void set_state(std::size_t member, const State& state) {
    places_[member] = {state.wall, state.u, state.cell};
    phase_.position[member] = state.position;
    phase_.velocity[member] = state.velocity;
  }
  const Time& time() const { return time_; }
  void set_time(const Time& time) { time_ = time; }

  /// Takes the next step from phase(), which ends at `limit` at the latest, and finds what comes
  /// first.
  const Next& predict(const Time& limit);
  const Next& next() const { return next_; }
  /// When that is.
  Time next_time() const {
    return next_.member < 0 && whole_step_ ? path_end_ : time_ + next_.duration;
  }
  /// Evaluations of the forces since what comes first was predicted, for states within the step
  /// under way; all of a prediction that was dropped.
  std::uint64_t evaluations_under_way() const { return under_way_; }
  /// A prediction was interrupted: forgets all that it computed. Another one is needed before
  /// anything else.
  void drop_prediction();
  /// Goes to what was predicted.
  void advance();
  /// The state of a member at a time within the step under way.
  State state_at(std::size_t member, const Time& time);
  /// Crossings of a surface by a member between two times since the start of the step under way,
  /// not after what comes first; `origin`: of its cell.
  void crossings(const Surface& surface, std::size_t member, double from, double to,
                 geometry::Vector origin, std::vector<SurfaceCrossing>& found);
  double kinetic_energy() const;
  /// Kinetic and potential energy of all members at phase(), whose potentials the last evaluation
  /// of the forces may have given.
  double energy();
  bool has_energy() const { return last_energy_.has_value(); }
  /// What change_of_energy counts from; NaN: nothing yet.
  double last_energy() const {
    return last_energy_.value_or(std::numeric_limits<double>::quiet_NaN());
  }
  void set_last_energy(double energy) { last_energy_ = energy; }
  /// By how much that has changed since it was last asked for; 0 if others are members now.
  double change_of_energy();
  /// Forgets what is known of forces: whichever phase comes next, the same will be evaluated.
  void forget();
  /// Are the forces at the start, or the end, of the path under way known to the search for walls?
  bool arc_at_start() const { return !path_->start().acceleration.empty(); }
  bool arc_at_end() const { return !path_->end().acceleration.empty(); }
  /// Takes a member out.
  void remove(std::size_t member);
  /// Puts a member back into the lattice's cell.
  void fold(std::size_t member);
  /// Does a support other than `except` hold the point?
  bool supported(geometry::Vector x, const Barrier<double>* except) const;
  /// The lone member has come to that edge and does not leave there: until it was inside again, it
  /// has crossed it.
  void pass(const Barrier<double>& edge) { passed_ = &edge; }

 private:
  std::uint64_t evaluations() const { return in_.counts ? in_.counts->force_evaluations : 0; }
  bool interrupted(double work) const {
    return listens_ && in_.interrupt && in_.interrupt->after(work);
  }
  void find_maps();
  bool resolves(const Phase<double>& from, const Phase<double>* to,
                const forces::resolution::Span&) const;
  bool resolves_pairs(const Phase<double>& from, const forces::resolution::Span&) const;
  bool near_pairs_resolve(const Phase<double>& from, const forces::resolution::Span&);
  double force_there(const Phase<double>& at, std::size_t member) const;
  void find_far_pairs(const Phase<double>& from, const forces::resolution::Span&);
  bool resolves_at(const Phase<double>& at, const Phase<double>& other,
                   const forces::resolution::Span&);
  double distance(const Phase<double>& at, std::size_t i, std::size_t j) const;
  void add_pair_bound(std::size_t i, std::size_t j, double distance, double rho,
                      std::vector<forces::ForceBound>& sums) const;
  forces::ForceBound with_external(const Phase<double>& at, std::size_t member, double rho,
                                   const forces::ForceBound& pairs) const;
  bool bound_all(const Phase<double>& at, const std::vector<double>& rho,
                 std::vector<forces::ForceBound>& sums) const;
  std::string check_resolution();
  std::string describe_unresolved(const Phase<double>& at, double step, double radius);
  void find_next(const Time& limit);
  void find_within(const Time& limit);
  void halve(const Time& limit, const Barrier<double>* passed);
  double way_to_hit(double rest);
  double refined_hit(std::size_t member, const Barrier<double>&, double about,
                     std::span<const geometry::Vector> acceleration) const;
  void search(double way, double rest);
  void accelerations(std::span<const geometry::Vector> x,
                     std::span<geometry::Vector> a) const override;
  std::span<const double> masses() const override { return masses_; }
  double potential_energy(std::span<const geometry::Vector> x) const override;
  double energy_jumps() const override;
  double longest_step(const Phase<double>& from, const double& asked) const override;
  void make_stepper();
  Time step_end(const Time& limit) const;
  double resolution_radius(double step) const {
    return in_.plan.resolution_margin * step / forces::resolution::steps_a_radius;
  }
  /// A member that may come to a barrier within the step.
  struct Near {
    std::size_t member;
    const Barrier<double>* barrier;
    double about;  ///< when, roughly
  };
  std::vector<Near> near_walls(const CrossingSearch<double>&) const;
  StepPath<double>::Knot* first_exit(CrossingSearch<double>& search, const Barrier<double>& edge,
                                     StepPath<double>::Knot& to);
  std::string_view fault_at(const Phase<double>& phase) const;
  bool is_edge(const Barrier<double>& b) const {
    return !in_.supports.empty() && b.wall >= in_.supports.front().wall;
  }
  void watch(const Phase<double>& end);

  const Surroundings& in_;
  struct Evaluated {
    std::vector<geometry::Vector> position;
    double energy = 0.0;
  };
  mutable Evaluated external_;  ///< the potentials of the latest evaluation, if they are remembered
  std::optional<double> last_energy_;  ///< as of change_of_energy; empty: of other members
  std::vector<int> bodies_;
  std::vector<Particle> particles_;
  std::vector<double> omega_, masses_;
  struct Place {
    int wall = -1;
    double u = 0.0;
    geometry::Cell cell;
  };
  std::vector<Place> places_;  ///< what a phase does not tell of a state
  Phase<double> phase_;
  Time time_;
  Next next_;
  bool listens_ = false;                     ///< an interrupt may end what is computed now
  const Barrier<double>* passed_ = nullptr;  ///< an edge that the next step starts on
  /// The last state that was asked for within the step under way.
  struct {
    double duration = -1.0;
    Phase<double> phase;
  } between_;
  std::uint64_t began_at_ = 0, under_way_ = 0;  ///< evaluations of the forces
  bool whole_step_ = false;                     ///< the path under way ends at path_end_
  Time path_end_;                               ///< of the step
  double part_ = 0.0;      ///< ends of steps are its multiples: the plan's step, or a part of it
  bool describes_ = true;  ///< a fault is described in words
  std::unique_ptr<Stepper<double>> stepper_;
  std::unique_ptr<StepPath<double>> path_;
  std::vector<forces::ForceMap*> maps_;  ///< one a member
  double largest_omega_ = 0.0;           ///< in size
  forces::resolution::Span span_;        ///< of half of the step that was checked last
  /// Bounds of the forces of pairs that are far from each other, wherever within `radius` of
  /// `centre` each particle is, at complex places too; and the pairs that are not far.
  struct FarPairs {
    std::vector<geometry::Vector> centre;
    std::vector<double> radius;
    std::vector<forces::ForceBound> force;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> near;
    std::vector<double> here;  ///< about what bounds the accelerations where the group is
  } far_;
  Phase<double>
      checked_;  ///< a step has ended there and resolved what lies about it; empty: none has
};

/// The instant k * step.
Time multiple(double k, double step);
/// The multiple of the step that comes next after `now`; infinite where 2^52 steps or more lie
/// behind it.
Time next_multiple(const Time& now, double step);
/// The middle of a lattice's cell.
geometry::Vector centre_of_cell(const geometry::Lattice&);
/// Puts a point back into the cell about that centre, and counts the cells it came through.
void fold_towards_centre(const geometry::Lattice&, geometry::Vector centre, geometry::Vector& x,
                         geometry::Cell&);

}  // namespace carom::events
