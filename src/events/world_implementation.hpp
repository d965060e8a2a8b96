// The inside of World: particles, queue and groups. world.cpp holds the loop and free flights,
// world_groups.cpp what integration and hand-over add.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/interrupt.hpp"
#include "carom/base/twofold.hpp"
#include "carom/events/decision_range.hpp"
#include "carom/events/world.hpp"
#include "events/contacts.hpp"
#include "events/group.hpp"
#include "events/locator.hpp"
#include "events/next_hit.hpp"
#include "events/queue.hpp"

namespace carom {

inline constexpr Time never{std::numeric_limits<double>::infinity()};

/// A particle. It flies freely, or belongs to a group.
struct Body {
  Particle particle;
  geometry::EnergyShell<double> shell;
  State state;
  Flight flight;
  Ahead ahead;
  std::uint64_t hits = 0;
  int last_wall = -1;
  int hole = -1;
  Fate fate = Fate::survived;
  bool finished = false;
  int group = -1;       ///< index into groups, -1: free
  Time last_event;      ///< integrated: its last hit or start
  Time check = never;   ///< free: when another particle may be near at the earliest
  /// How far crossings of the watched surface have been reported, and the state there in the plane.
  struct Watched {
    bool begun = false;
    geometry::Vector position, velocity;
    Time time;
  } watched;
  std::string report;
};

class World::Implementation {
 public:
  Implementation(const Table& table, const Dynamics& dynamics, DecisionOptions options);

  void predict(int index, Body& body);
  void enqueue(int index, const Body& body);
  void fly(int index);  ///< predict, for callers that it is not inlined into
  void apply(int index, Time now, Observer& observer);
  void apply_own(int index, Observer& observer);  ///< apply, likewise
  void fly_on(int index);  ///< enqueue, likewise
  void reflect(int index, Body& body, Time now, Observer& observer, const HitFinder::Landing& landing);
  void end(int index, Fate fate, Time time, Observer* observer, std::string_view why = {});
  void emit_samples(Time until, bool inclusive, Observer& observer);
  State state_at(const Body& body, Time t) const;
  bool fails_before(const Body& body, Time t) const;
  bool end_failed_steps(Time t_end, Observer& observer);
  void check_speed(const Body& body) const;
  void begin_free(Body& body);
  bool contains(geometry::Vector point);

  // Sections (world_sections.cpp).
  void begin_watching();
  void watch_event(int index, Time when, Observer& observer);  ///< after an event was applied
  void watch_group(Group& group, Time until, Observer& observer);
  void watch_until(Time t_end, Observer& observer);
  void watch_flight(int index, Time until, const geometry::Vector* end, Observer& observer);
  geometry::Vector in_plane(geometry::Vector position, const geometry::Cell& cell) const;

  // Interactions of finite range (world_ranges.cpp).
  double gap_between(const Body& a, geometry::Vector x, const Body& b, geometry::Vector y) const;
  bool gather(std::vector<int>& members, const Time& now, double& free_for, Observer& observer);
  void join(std::vector<int> members, const Time& now);
  std::vector<int> company(int index, const Time& now, double& free_for, Observer& observer);
  void look_around(int index, const Time& now, Observer& observer);
  bool regroup(Group& group, Observer& observer);
  bool split(const std::vector<int>& members, Observer& observer);

  // Integration and hand-over (world_groups.cpp).
  void add_barriers();
  bool integrated_at(geometry::Vector x) const;
  void form_group(std::vector<int> members);
  void wait(int index);
  void meet(int index, Observer& observer);
  void start_integrating(int index, Observer& observer);
  void integrate(int index, const Time& now, Observer& observer);
  void predict_group(int leader);
  void predict_again();
  void apply_group(int leader, Observer& observer);
  void hit_in_group(Group& group, std::size_t member, const Barrier<double>& barrier, Observer& observer);
  void lose(Group& group, std::size_t member, std::string_view why, Observer& observer);
  bool leave_support(Group& group, const Barrier<double>& barrier, Observer& observer);
  bool leave_between_supports(Group& group, Observer& observer);
  void set_free(int index);
  void enter_support(int index, const HitFinder::Landing& landing, Observer& observer);
  void take_out(Group& group, std::size_t member);
  void take_out_of_group(int index);
  void copy_states(const Group& group);
  bool is_support(int wall) const { return wall >= wall_count; }

  // Energies (world_energy.cpp).
  bool share_energy() const { return one_group || by_range; }
  EnergyBalance& balance_of(const Group& group);
  void look_at_start(Group& group);
  void look_at_end(Group& group);

  // Hard discs (world_contacts.cpp).
  void add_contacts();
  void add_disc(int index);
  void check_disc(Body& body) const;
  bool prepare_contacts();
  void apply_disc(int index, Observer& observer);
  void look_ahead(int index, const Time& now);
  void look_again(int index, int partner, const Time& now);
  void enter_disc(int index, const Time& now);
  void keep_own(int index);
  void collide(int finding, Observer& observer);
  geometry::Cell advance_disc(int index, const Time& now);
  void start_disc(int index, double way, Observer& observer);
  bool settle_on_wall(int index, double way, Observer& observer);

  const Table& table;             ///< the user's
  const DecisionRange scales;     ///< of it
  Dynamics dynamics;
  /// The same with the edges of supports as walls, or as the centres of hard discs see it, if there are any.
  Table with_supports;
  int wall_count = 0;             ///< of the user's table
  HitFinder finder;
  std::unique_ptr<Locator> locator;
  std::vector<int> corners;  // order n of the corner at each wall's start, 0: none
  std::vector<Body> bodies;
  EventQueue queue;
  HitEvent event;  // filled in place, number by number so that no number waits for another
  DecisionCounts counts;
  std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();
  std::vector<double> sample_times;
  double sample_interval = 0.0;
  std::uint64_t next_sample = 0;
  bool sampling = false;
  std::vector<std::pair<int, State>> seen;  ///< of the sample under way
  std::function<bool()> enough;         ///< ends a run, or is empty
  const Surface* surface = nullptr;     ///< watched, or null
  std::size_t most_crossings = 0;       ///< of one flight
  std::vector<SurfaceCrossing> found;

  bool integrates = false;        ///< forces act somewhere, or everything is to be integrated
  bool one_group = false;         ///< the particles interact at any distance
  bool by_range = false;          ///< they interact within a range: groups merge and split
  Group::Surroundings surroundings;
  Interrupt interrupt;            ///< of the run under way
  bool unpredicted = false;       ///< the last run was interrupted within the prediction of a group
  StepCounts steps;
  std::vector<EnergyBalance> balances;  ///< one a body; where they interact the first is that of all
  std::vector<Twofold> changes;         ///< their changes, without the rounding of sums
  std::vector<std::unique_ptr<Group>> groups;
  std::vector<int> idle_groups;   ///< kept for the next particle that comes under a force
  std::unique_ptr<Contacts> contacts;  ///< of hard discs, or null
  bool unprepared = false;        ///< discs have been added
  Time clock;                     ///< of the last event of discs
  std::vector<int> partners;
  std::vector<int> waiting;       ///< bodies that are to be integrated from their time on
};

}  // namespace carom
