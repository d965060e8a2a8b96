#include "analyses/compare/precise_path.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "carom/integrators/arithmetic.hpp"
#include "events/step/barriers_of.hpp"
#include "events/step/crossing_in_step.hpp"
#include "events/step/group.hpp"
#include "events/step/group_hit.hpp"
#include "events/step/surroundings.hpp"
#include "forces/quad_forces.hpp"
#include "integrators/splitting.hpp"

namespace carom {

template <>
struct Arithmetic<forces::Quad> {
  static forces::Quad parse(std::string_view decimal) { return forces::Quad::parse(decimal); }
  static SineCosine<forces::Quad> turn(const forces::Quad& angle) {
    const auto [sine, cosine] = sine_and_cosine(angle);
    return {sine, cosine};
  }
};

namespace analyses {

namespace {

using Barrier = events::Barrier<Quad>;
using Path = events::StepPath<Quad>;

class Law final : public ForceLaw<Quad> {
 public:
  explicit Law(const Runs& runs)
      : runs_(runs),
        forces_(runs.system().dynamics.forces->spec(), runs.system().particles,
                runs.system().table->lattice) {}
  void accelerations(std::span<const QuadVector> position,
                     std::span<QuadVector> acceleration) const override {
    runs_.stop_if_asked();
    const int terms = forces_.accelerations(position, acceleration);
    // Where no copy of a bump is near, it was looked for.
    terms_ += std::max(static_cast<double>(terms), static_cast<double>(position.size()));
  }
  /// That have been evaluated so far.
  double terms() const { return terms_; }

 private:
  const Runs& runs_;
  forces::QuadForces forces_;
  mutable double terms_ = 0.0;
};

bool is_number(const QuadVector& a) { return a.x == a.x && a.y == a.y; }

QuadVector translation(const std::optional<geometry::Lattice>& lattice, const geometry::Cell& c) {
  if (!lattice) return {};
  const Quad first(static_cast<double>(c.first)), second(static_cast<double>(c.second));
  return first * QuadVector{lattice->first.x, lattice->first.y} +
         second * QuadVector{lattice->second.x, lattice->second.y};
}

/// The table's walls in 34 digits, and the exact answer whether a particle is inside.
class Walls {
 public:
  explicit Walls(const Table& table)
      : table_(table),
        inside_(table),
        longest_way_(events::longest_way(table)),
        in_doubles_(events::barriers_of(table)) {
    if (table.lattice) centre_ = events::centre_of_cell(*table.lattice);
    for (const events::Barrier<double>& b : in_doubles_) {
      if (!b.begins_wall) continue;  // it came with the part before it
      const QuadVector shift = translation(table.lattice, b.cell);
      for (Barrier& own : events::barriers_of<Quad>(table, b.wall, shift))
        barriers_.push_back(std::move(own));
    }
  }

  bool none() const { return barriers_.empty(); }
  const std::vector<Barrier>& barriers() const { return barriers_; }
  /// Inside, or on a wall to the rounding of doubles.
  bool hold(const QuadVector& x) const {
    const geometry::Vector place = rounded(x);
    return events::on_some_wall(in_doubles_, static_cast<int>(table_.walls.size()), place) ||
           inside_.contains(place);
  }
  /// May walls be missed, as the path leads too far?
  bool too_far(const QuadVector& from, const QuadVector& to) const {
    return !(length(rounded(to - from)) <= longest_way_);
  }
  /// Back into the cell about the origin, from where the barriers are seen.
  void fold(PrecisePlace& place) const {
    if (none() || !table_.lattice) return;
    for (std::size_t i = 0; i < place.cells.size(); ++i) {
      QuadVector& x = place.phase.position[i];
      geometry::Vector about = rounded(x);
      geometry::Cell beyond;
      events::fold_towards_centre(*table_.lattice, centre_, about, beyond);
      if (beyond == geometry::Cell{}) continue;
      x = x - translation(table_.lattice, beyond);
      place.cells[i].first += beyond.first;
      place.cells[i].second += beyond.second;
    }
  }

 private:
  const Table& table_;
  World inside_;
  double longest_way_;
  geometry::Vector centre_;
  std::vector<events::Barrier<double>> in_doubles_;
  std::vector<Barrier> barriers_;
};

std::vector<Quad> omegas(const System& system) {
  std::vector<Quad> list;
  for (const Particle& p : system.particles) list.emplace_back(p.omega);
  return list;
}

}  // namespace

class PreciseMotion::Motion {
 public:
  Motion(const Runs& runs, const Scheme& scheme)
      : runs_(runs),
        table_(*runs.system().table),
        law_(runs),
        walls_(table_),
        omega_(omegas(runs.system())),
        stepper_(scheme, law_, omega_),
        path_(stepper_, law_, omega_) {}

  PrecisePlace start() const {
    PrecisePlace place;
    for (const State& s : runs_.starts()) {
      place.phase.position.push_back({s.position.x, s.position.y});
      place.phase.velocity.push_back({s.velocity.x, s.velocity.y});
      place.cells.push_back(s.cell);
    }
    return place;
  }

  double terms() const { return law_.terms(); }

  std::optional<PrecisePath> follow(const PrecisePlace& from, const Quad& t, int steps_a_part,
                                    std::span<const ComparedHit> expected, double most_terms) {
    PrecisePath path;
    PrecisePlace& now = path.end;
    now = from;
    path_.forget();
    const Quad step = t / Quad(static_cast<double>(parts) * steps_a_part);
    for (int part = 1; part <= parts; ++part) {
      for (int k = 0; k < steps_a_part; ++k) {
        const Quad begin = Quad(static_cast<double>((part - 1) * steps_a_part + k)) * step;
        if (law_.terms() > most_terms || !take_step(begin, step, expected, path)) return {};
      }
      if (part > parts - states_compared) path.states.push_back(in_the_plane(now));
    }
    if (path.hits.size() < expected.size()) return {};
    return path;
  }

 private:
  Phase<Quad> in_the_plane(const PrecisePlace& place) const {
    Phase<Quad> phase = place.phase;
    for (std::size_t i = 0; i < place.cells.size(); ++i)
      phase.position[i] = phase.position[i] + translation(table_.lattice, place.cells[i]);
    return phase;
  }

  /// One whole step, cut at each hit. False where the path does not go as expected.
  bool take_step(const Quad& begin, const Quad& step, std::span<const ComparedHit> expected,
                 PrecisePath& path) {
    PrecisePlace& now = path.end;
    if (walls_.none()) {
      stepper_.step(now.phase, step, next_);
      std::swap(now.phase, next_);
      return std::all_of(now.phase.position.begin(), now.phase.position.end(), is_number);
    }
    for (Quad done(0.0); done < step;) {
      walls_.fold(now);
      path_.begin(now.phase, step - done);
      const std::optional<Meeting> first = first_meeting();
      if (!first) return false;
      now.phase = first->knot->phase;
      if (!first->barrier) return true;
      done = done + first->knot->time;
      if (path.hits.size() == expected.size()) return false;
      const ComparedHit& other = expected[path.hits.size()];
      if (other.particle != static_cast<int>(first->particle) ||
          other.wall != first->barrier->wall || !reflect(*first, begin + done, path))
        return false;
    }
    return true;
  }

  struct Meeting {
    Path::Knot* knot;
    const Barrier* barrier = nullptr;  ///< null: the step ends there
    std::size_t particle = 0;
  };

  /// What comes first on the path under way. Nothing if that is not known.
  std::optional<Meeting> first_meeting() {
    Meeting first{&path_.end()};
    const std::size_t n = path_.end().phase.position.size();
    std::vector<bool> near(n, false);
    events::CrossingSearch<Quad> search(path_);
    for (std::size_t i = 0; i < n; ++i) {
      const QuadVector &from = path_.start().phase.position[i], &to = path_.end().phase.position[i];
      if (!is_number(to) || walls_.too_far(from, to)) return {};
      const events::PathHull<Quad> hull(path_.start(), path_.end(), i);
      for (const Barrier& b : walls_.barriers()) {
        if (stays_off(b, hull)) continue;
        near[i] = true;
        Path::Knot* found = search.first(b, i, path_.start(), *first.knot);
        if (search.gave_up() || (found && search.slides())) return {};
        if (found) first = {found, &b, i};
      }
    }
    for (std::size_t i = 0; i < n; ++i)
      if (near[i] && !(first.barrier && first.particle == i) &&
          !walls_.hold(first.knot->phase.position[i]))
        return {};
    return first;
  }

  /// Turns the velocity at a hit. False if it points along the wall to rounding.
  static bool turns_inwards(const Barrier& b, const QuadVector& x, QuadVector& v) {
    const QuadVector n = b.normal(x);
    if (!(b.rate(x, v) < -b.rate_rounding(x, v))) return false;
    v = v - (Quad(2.0) * dot(v, n) / dot(n, n)) * n;
    return b.rate(x, v) > b.rate_rounding(x, v);
  }

  bool reflect(const Meeting& at, const Quad& t, PrecisePath& path) {
    PrecisePlace& now = path.end;
    const QuadVector& x = now.phase.position[at.particle];
    QuadVector& v = now.phase.velocity[at.particle];
    const QuadVector before = v;
    if (!turns_inwards(*at.barrier, x, v)) return false;
    // Half of what the reflection changes is the part across.
    path.hits.push_back({static_cast<int>(at.particle), at.barrier->wall, t,
                         x + translation(table_.lattice, now.cells[at.particle]),
                         length(rounded(before)), 0.5 * length(rounded(v - before))});
    return true;
  }

  const Runs& runs_;
  const Table& table_;
  Law law_;
  Walls walls_;
  std::vector<Quad> omega_;
  integrators::SplittingStepper<Quad> stepper_;
  Path path_;
  Phase<Quad> next_;
};

PreciseMotion::PreciseMotion(const Runs& runs, const Scheme& scheme)
    : motion_(std::make_unique<Motion>(runs, scheme)) {}
PreciseMotion::~PreciseMotion() = default;
PrecisePlace PreciseMotion::start() const { return motion_->start(); }
double PreciseMotion::terms() const { return motion_->terms(); }
std::optional<PrecisePath> PreciseMotion::follow(const PrecisePlace& from, const Quad& t,
                                                 int steps_a_part,
                                                 std::span<const ComparedHit> expected,
                                                 double most_terms) {
  return motion_->follow(from, t, steps_a_part, expected, most_terms);
}

}  // namespace analyses
}  // namespace carom
