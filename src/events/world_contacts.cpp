// Hard discs among the events of a world.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "carom/base/error.hpp"
#include "events/table_with_supports.hpp"
#include "events/world_implementation.hpp"
#include "motion/contact.hpp"
#include "motion/free_motion.hpp"
#include "table/inset.hpp"

namespace carom {

using geometry::Cell;
using geometry::Vector;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

InputError refused(const char* problem, const char* expected) {
  Place place;
  place.key = "interaction";
  return InputError(place, problem, expected);
}

/// Does the separation at a contact tell the direction from centre to centre? Its length is the sum of the radii, but for
/// rounding, which turns it by as much as it stretches it.
bool points_along_centres(Vector d, double reach) {
  constexpr double share = 0x1p-10;
  return std::fabs(std::sqrt(dot(d, d)) - reach) <= share * reach;
}

/// Hits as the user's table has them: the finder knows the walls that centres of discs meet.
class OnWalls final : public Observer {
 public:
  OnWalls(const Table& table, Observer& observer) : table_(table), observer_(observer) {}
  void hit(const HitEvent& event) override {
    HitEvent seen = event;
    seen.u = touched_parameter(table_.walls[at(event.wall)], event.u, event.position);
    observer_.hit(seen);
  }
  void end(const EndEvent& event) override { observer_.end(event); }

 private:
  const Table& table_;
  Observer& observer_;
};

}  // namespace

Table table_of_discs(const Table& table, const Dynamics& dynamics) {
  const std::vector<double>& radii = dynamics.forces->disc_radii();
  if (dynamics.everywhere || !dynamics.forces->empty())
    throw refused("hard discs fly freely from contact to contact, and nothing else may act on them",
                  "no potential, and not --engine steps");
  if (table.walls.empty()) return {};
  if (std::any_of(radii.begin(), radii.end(), [&](double r) { return r != radii.front(); }))
    throw refused("between walls all discs have one radius", "one radius, or a table without walls");
  return inset_table(table, radii.front());
}

void World::Implementation::add_contacts() {
  if (!dynamics.forces || dynamics.forces->disc_radii().empty()) return;
  contacts = std::make_unique<Contacts>(table.lattice ? &*table.lattice : nullptr);
}

namespace {

/// The course of a disc from its body's state on.
void set_course(Contacts::Disc& disc, const Body& b) {
  disc.position = b.state.position;
  disc.velocity = b.state.velocity;
  disc.time = b.state.time;
  disc.omega = b.particle.omega;
  disc.radius = b.particle.radius;
  disc.speed = b.particle.speed;
}

}  // namespace

/// A disc that is to be added: its speed is that of its start, and no other is where it is.
void World::Implementation::check_disc(Body& b) const {
  const std::vector<double>& radii = dynamics.forces->disc_radii();
  if (std::find(radii.begin(), radii.end(), b.particle.radius) == radii.end())
    throw std::invalid_argument("the particle's radius is none of the discs'");
  if (b.particle.radius > contacts->largest_radius())
    throw std::invalid_argument("the disc overlaps its own copies on the lattice");
  b.particle.speed = std::sqrt(dot(b.state.velocity, b.state.velocity));
  Contacts::Disc disc;
  set_course(disc, b);
  const int other = contacts->overlapped(disc);
  if (other >= 0)
    throw std::invalid_argument("disc " + std::to_string(bodies.size()) + " overlaps disc " + std::to_string(other));
}

void World::Implementation::add_disc(int index) {
  contacts->add({});
  enter_disc(index, bodies[at(index)].state.time);
  unprepared = true;
}

/// The course of a disc from its state on, and what of its own comes next.
void World::Implementation::enter_disc(int index, const Time& now) {
  const Body& b = bodies[at(index)];
  set_course(contacts->disc(index), b);
  if (b.particle.speed > 0.0)
    fly(index);
  else
    queue.update(index, never, static_cast<int>(EventKind::unbounded));
  keep_own(index);
  if (!unprepared) contacts->anchor(index, now);
}

/// Keeps what the queue says of the disc alone.
void World::Implementation::keep_own(int index) {
  Contacts::Disc& disc = contacts->disc(index);
  disc.own = queue.key(index).time;
  disc.own_kind = queue.key(index).kind;
  // Nothing of its own lies ahead, but another disc may.
  const auto kind = static_cast<EventKind>(disc.own_kind);
  if (kind == EventKind::pinned || kind == EventKind::unbounded) disc.own = never;
}

/// The queue entry: the earliest of the disc's own next event, its contact, and looking round again.
void World::Implementation::look_ahead(int index, const Time& now) {
  Contacts::Disc& disc = contacts->disc(index);
  contacts->predict(index, now);
  constexpr int contact = static_cast<int>(EventKind::contact);
  const int partner = contacts->partner(index);
  if (partner >= 0) {
    queue.update(index, disc.meeting, contact);
    if (contacts->tell_partner(index)) queue.update(partner, disc.meeting, contact);
  } else if (disc.check < disc.own) {
    queue.update(index, disc.check, static_cast<int>(EventKind::neighbours));
  } else {
    queue.update(index, disc.own, disc.own_kind);
  }
}

/// Those who were to touch a disc that has changed its course.
void World::Implementation::look_again(int index, int partner, const Time& now) {
  contacts->partners_of(index, partners);
  for (const int other : partners)
    if (other != partner) look_ahead(other, now);
}

/// False if that was interrupted.
bool World::Implementation::prepare_contacts() {
  contacts->prepare(clock);
  for (int i = 0; i < contacts->size(); ++i) {
    if (interrupt.after(1000.0)) return false;
    if (contacts->disc(i).here) look_ahead(i, clock);
  }
  unprepared = false;
  return true;
}

void World::Implementation::apply_disc(int index, Observer& observer) {
  const EventQueue::Key key = queue.key(index);
  const Time now = key.time;
  clock = now;
  const auto kind = static_cast<EventKind>(key.kind);
  if (kind == EventKind::contact) return collide(index, observer);
  if (kind == EventKind::neighbours) {
    contacts->anchor(index, now);
    return look_ahead(index, now);
  }
  OnWalls on_walls(table, observer);
  apply_own(index, on_walls);
  const Body& b = bodies[at(index)];
  if (b.finished) {
    contacts->leave(index);
  } else if (kind == EventKind::cell_edge) {
    keep_own(index);
    return look_ahead(index, now);
  } else {
    enter_disc(index, now);
    look_ahead(index, now);
  }
  look_again(index, -1, now);
}

/// Brings a disc to the present, into the cell it is in. Returns the cell relative to the one before.
Cell World::Implementation::advance_disc(int index, const Time& now) {
  Body& b = bodies[at(index)];
  const auto [position, velocity] =
      moved(b.state.position, b.state.velocity, b.particle.omega, now - b.state.time);
  b.state.position = position;
  b.state.velocity = velocity;
  b.state.time = now;
  Cell by;
  // The edges that were crossed; then, where rounding left the point beyond one, that one.
  Cell step = b.flight.cell;
  for (int i = 0; table.lattice && i < 4 && !(step == Cell{}); ++i) {
    b.state.position = b.state.position - table.lattice->translation(step);
    by.first += step.first;
    by.second += step.second;
    Flight flight;
    flight.start = b.state.position;
    flight.velocity = b.particle.speed > 0.0 ? b.state.velocity : Vector{1.0, 0.0};
    finder.begin(flight);
    step = flight.cell;
  }
  b.state.cell.first += by.first;
  b.state.cell.second += by.second;
  return by;
}

void World::Implementation::collide(int finding, Observer& observer) {
  const Time now = queue.key(finding).time;
  const int index = std::min(finding, contacts->partner(finding)),
            other = std::max(finding, contacts->partner(finding));
  Cell copy = contacts->disc(finding).copy;
  if (index != finding) copy = {-copy.first, -copy.second};
  Body& a = bodies[at(index)];
  Body& b = bodies[at(other)];
  const double way = a.particle.speed * (now - a.state.time),
               other_way = b.particle.speed * (now - b.state.time);
  const bool stays = a.state.time == now, other_stays = b.state.time == now;
  const Cell first = advance_disc(index, now), second = advance_disc(other, now);
  copy.first += second.first - first.first;
  copy.second += second.second - first.second;
  const Vector d = contacts->separation(a.state.position, b.state.position, copy);
  if (!points_along_centres(d, a.particle.radius + b.particle.radius)) {
    for (const int disc : {index, other}) {
      end(disc, Fate::unresolved, now, &observer,
          "at this contact rounding of the positions hides where the other disc is: the discs are too small for so large a "
          "table, or have gone too far");
      contacts->leave(disc);
    }
    look_again(index, other, now);
    return look_again(other, index, now);
  }
  ContactEvent contact;
  contact.first = index;
  contact.second = other;
  contact.time = now;
  contact.separation = d;
  contact.first_before = a.state.velocity;
  contact.second_before = b.state.velocity;
  const ElasticContact after =
      elastic_contact(d, a.state.velocity, b.state.velocity, a.particle.mass, b.particle.mass);
  contact.first_after = a.state.velocity = after.first;
  contact.second_after = b.state.velocity = after.second;
  contact.transfer = after.transfer;
  contact.first_position = a.state.position;
  contact.second_position = b.state.position;
  contact.first_cell = a.state.cell;
  contact.second_cell = b.state.cell;
  observer.contact(contact);
  start_disc(index, stays ? 0.0 : way, observer);
  start_disc(other, other_stays ? 0.0 : other_way, observer);
  if (!a.finished) look_ahead(index, now);
  if (!b.finished) look_ahead(other, now);
  look_again(index, other, now);
  look_again(other, index, now);
  if (surface) watch_event(finding == index ? other : index, now, observer);
}

/// A disc goes on from its state after a contact.
void World::Implementation::start_disc(int index, double way, Observer& observer) {
  Body& b = bodies[at(index)];
  b.particle.speed = std::sqrt(dot(b.state.velocity, b.state.velocity));
  b.flight = Flight{};
  b.state.wall = -1;
  if (b.particle.speed > 0.0) {
    if (!settle_on_wall(index, way, observer)) {
      contacts->leave(index);
      return;
    }
    begin_free(b);
  }
  enter_disc(index, b.state.time);
}

/// Where walls are within rounding, the disc is at the wall; if it was pushed against it, it is reflected
/// at once. False if it ends there.
bool World::Implementation::settle_on_wall(int index, double way, Observer& observer) {
  Body& b = bodies[at(index)];
  const std::vector<Wall>& walls = finder.table().walls;
  const std::int64_t range = table.lattice && !walls.empty() ? 1 : 0;
  for (int w = 0; w < static_cast<int>(walls.size()); ++w)
    for (std::int64_t m = -range; m <= range; ++m)
      for (std::int64_t n = -range; n <= range; ++n) {
        const Vector x =
            table.lattice ? b.state.position - table.lattice->translation({m, n}) : b.state.position;
        const geometry::PreparedCurve& curve = finder.curve(w);
        // Position and time of the flight err by a few units of what they are made of.
        const double bound =
            32.0 * geometry::unit_roundoff * (norm_1(x) + norm_1(b.state.position) + curve.extent + way);
        const geometry::PreparedCurve::Frame frame = curve.settle(x);
        if (!(norm_1(frame.point - x) <= bound)) continue;
        const double u = curve.parameter(frame.point);
        if (!(norm_1(curve.point(u) - x) <= 2.0 * bound)) continue;  // beyond its ends
        b.state.wall = w;
        b.state.u = u;
        b.state.position = frame.point;
        b.state.cell.first += m;
        b.state.cell.second += n;
        Sign inward = finder.inward(w, u, b.state.velocity, frame.normal, counts);
        if (inward == Sign::positive) return true;
        const Time now = b.state.time;
        for (const int h : finder.table().walls[at(w)].holes) {
          const Hole& hole = finder.table().holes[at(h)];
          if (inward != Sign::negative || !(hole.from <= u && u < hole.to)) continue;
          b.hole = h;
          end(index, Fate::escaped, now, &observer);
          return false;
        }
        const Vector before = b.state.velocity;
        for (int i = 0; i < 2 && inward == Sign::negative; ++i) {
          b.state.velocity = geometry::reflected(b.state.velocity, frame.normal, frame.square, frame.k, 0.0);
          inward = finder.inward(w, u, b.state.velocity, frame.normal, counts);
        }
        if (inward != Sign::positive) {
          end(index, Fate::singular, now, &observer);
          return false;
        }
        ++b.hits;
        b.last_wall = w;
        event.particle = index;
        event.wall = w;
        event.u = u;
        event.time = now;
        event.flight_time = 0.0;
        event.position = frame.point;
        event.cell = b.state.cell;
        event.before = before;
        event.after = b.state.velocity;
        event.reflections = 1;
        OnWalls(table, observer).hit(event);
        if (b.hits < limit) return true;
        end(index, Fate::capped, now, &observer);
        return false;
      }
  return true;
}

}  // namespace carom
