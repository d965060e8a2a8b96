#include "events/disc/disc_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "base/index.hpp"
#include "carom/base/error.hpp"
#include "motion/contact.hpp"
#include "motion/free_motion.hpp"
#include "table/inset.hpp"

namespace carom::events {

using geometry::Cell;
using geometry::Vector;

namespace {

using base::at;

InputError refused(const char* problem, const char* expected) {
  Place place;
  place.key = "interaction";
  return InputError(place, problem, expected);
}

/// Does the separation at a contact tell the direction from centre to centre? Its length is the sum
/// of the radii, except for rounding, which turns it by as much as it stretches it.
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
    seen.u = table::touched_parameter(table_.walls[at(event.wall)], event.u, event.position);
    observer_.hit(seen);
  }
  void end(const EndEvent& event) override { observer_.end(event); }

 private:
  const Table& table_;
  Observer& observer_;
};

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

Table table_of_discs(const Table& table, const Dynamics& dynamics) {
  const std::vector<double>& radii = dynamics.forces->disc_radii();
  if (dynamics.everywhere || !dynamics.forces->empty())
    throw refused("hard discs fly freely from contact to contact, and nothing else may act on them",
                  "no potential, and not --engine steps");
  if (table.walls.empty()) return {};
  if (std::any_of(radii.begin(), radii.end(), [&](double r) { return r != radii.front(); }))
    throw refused("between walls all discs have one radius",
                  "one radius, or a table without walls");
  return table::inset_table(table, radii.front());
}

DiscContacts::DiscContacts(const Table& table, const Dynamics& dynamics, Bodies& bodies,
                           FreeFlights& flights, SectionWatch& watch, base::Interrupt& interrupt)
    : table_(table),
      radii_(dynamics.forces->disc_radii()),
      bodies_(bodies),
      flights_(flights),
      watch_(watch),
      interrupt_(interrupt),
      contacts_(table.lattice ? &*table.lattice : nullptr) {
  flights_.keep_to_cells();
}

void DiscContacts::check(const Body& b) const {
  if (std::find(radii_.begin(), radii_.end(), b.particle.radius) == radii_.end())
    throw std::invalid_argument("the particle's radius is none of the discs'");
  if (b.particle.radius > contacts_.largest_radius())
    throw std::invalid_argument("the disc overlaps its own copies on the lattice");
  Contacts::Disc disc;
  set_course(disc, b);
  const int other = contacts_.overlapped(disc);
  if (other >= 0)
    throw std::invalid_argument("disc " + std::to_string(bodies_.size()) + " overlaps disc " +
                                std::to_string(other));
}

void DiscContacts::add(int index) {
  contacts_.add({});
  enter(index, bodies_[index].state.time);
  unprepared_ = true;
}

void DiscContacts::clear() {
  contacts_.clear();
  clock_ = Time();
}

/// The course of a disc from its state on, and what of its own comes next.
void DiscContacts::enter(int index, const Time& now) {
  const Body& b = bodies_[index];
  set_course(contacts_.disc(index), b);
  if (b.particle.speed > 0.0)
    flights_.predict(index);
  else
    bodies_.schedule(index, never, EventKind::unbounded);
  keep_own(index);
  if (!unprepared_) contacts_.anchor(index, now);
}

/// Keeps what the queue says of the disc alone.
void DiscContacts::keep_own(int index) {
  Contacts::Disc& disc = contacts_.disc(index);
  const EventKind kind = bodies_.what(index);
  disc.own = bodies_.when(index);
  disc.own_kind = static_cast<int>(kind);
  // Nothing of its own lies ahead, but another disc may.
  if (kind == EventKind::pinned || kind == EventKind::unbounded) disc.own = never;
}

/// The queue entry: the earliest of the disc's own next event, its contact, and looking round
/// again.
void DiscContacts::look_ahead(int index, const Time& now) {
  const Contacts::Disc& disc = contacts_.disc(index);
  contacts_.predict(index, now);
  const int partner = contacts_.partner(index);
  if (partner >= 0) {
    bodies_.schedule(index, disc.meeting, EventKind::contact);
    if (contacts_.tell_partner(index)) bodies_.schedule(partner, disc.meeting, EventKind::contact);
  } else if (disc.check < disc.own) {
    bodies_.schedule(index, disc.check, EventKind::neighbours);
  } else {
    bodies_.schedule(index, disc.own, static_cast<EventKind>(disc.own_kind));
  }
}

/// Predicts anew for the discs that were to touch one that has changed its course.
void DiscContacts::look_again(int index, int partner, const Time& now) {
  contacts_.partners_of(index, partners_);
  for (const int other : partners_)
    if (other != partner) look_ahead(other, now);
}

bool DiscContacts::begin_run() {
  if (!unprepared_) return true;
  contacts_.prepare(clock_);
  for (int i = 0; i < contacts_.size(); ++i) {
    if (interrupt_.after(1000.0)) return false;
    if (contacts_.disc(i).here) look_ahead(i, clock_);
  }
  unprepared_ = false;
  return true;
}

void DiscContacts::apply(int index, Observer& observer) {
  const Time now = bodies_.when(index);
  clock_ = now;
  const EventKind kind = bodies_.what(index);
  if (kind == EventKind::contact) return collide(index, observer);
  if (kind == EventKind::neighbours) {
    contacts_.anchor(index, now);
    return look_ahead(index, now);
  }
  OnWalls on_walls(table_, observer);
  flights_.apply_apart(index, now, on_walls);
  if (bodies_[index].finished) {
    contacts_.leave(index);
  } else if (kind == EventKind::cell_edge) {
    keep_own(index);
    return look_ahead(index, now);
  } else {
    enter(index, now);
    look_ahead(index, now);
  }
  look_again(index, -1, now);
}

/// Brings a disc to the present, into the cell it is in. Returns the cell relative to the one
/// before.
Cell DiscContacts::advance(int index, const Time& now) {
  Body& b = bodies_[index];
  const auto [position, velocity] =
      motion::moved(b.state.position, b.state.velocity, b.particle.omega, now - b.state.time);
  b.state.position = position;
  b.state.velocity = velocity;
  b.state.time = now;
  Cell by;
  // The edges that were crossed; then, where rounding left the point beyond one, that one.
  Cell step = b.flight.cell;
  for (int i = 0; table_.lattice && i < 4 && !(step == Cell{}); ++i) {
    b.state.position = b.state.position - table_.lattice->translation(step);
    by.first += step.first;
    by.second += step.second;
    Flight flight;
    flight.start = b.state.position;
    flight.velocity = b.particle.speed > 0.0 ? b.state.velocity : Vector{1.0, 0.0};
    flights_.pieces().begin(flight);
    step = flight.cell;
  }
  b.state.cell.first += by.first;
  b.state.cell.second += by.second;
  return by;
}

void DiscContacts::collide(int finding, Observer& observer) {
  const Time now = bodies_.when(finding);
  const int index = std::min(finding, contacts_.partner(finding)),
            other = std::max(finding, contacts_.partner(finding));
  Cell copy = contacts_.disc(finding).copy;
  if (index != finding) copy = {-copy.first, -copy.second};
  Body& a = bodies_[index];
  Body& b = bodies_[other];
  const double way = a.particle.speed * (now - a.state.time),
               other_way = b.particle.speed * (now - b.state.time);
  const bool stays = a.state.time == now, other_stays = b.state.time == now;
  const Cell first = advance(index, now), second = advance(other, now);
  copy.first += second.first - first.first;
  copy.second += second.second - first.second;
  const Vector d = contacts_.separation(a.state.position, b.state.position, copy);
  if (!points_along_centres(d, a.particle.radius + b.particle.radius))
    return give_up(index, other, now, observer);
  ContactEvent contact;
  contact.first = index;
  contact.second = other;
  contact.time = now;
  contact.separation = d;
  contact.first_before = a.state.velocity;
  contact.second_before = b.state.velocity;
  const motion::ElasticContact after = motion::elastic_contact(
      d, a.state.velocity, b.state.velocity, a.particle.mass, b.particle.mass);
  contact.first_after = a.state.velocity = after.first;
  contact.second_after = b.state.velocity = after.second;
  contact.transfer = after.transfer;
  contact.first_position = a.state.position;
  contact.second_position = b.state.position;
  contact.first_cell = a.state.cell;
  contact.second_cell = b.state.cell;
  observer.contact(contact);
  start(index, stays ? 0.0 : way, observer);
  start(other, other_stays ? 0.0 : other_way, observer);
  if (!a.finished) look_ahead(index, now);
  if (!b.finished) look_ahead(other, now);
  look_again(index, other, now);
  look_again(other, index, now);
  if (watch_.active()) watch_.after_event(finding == index ? other : index, now, observer);
}

/// Ends both discs at a contact whose direction is not known.
void DiscContacts::give_up(int index, int other, const Time& now, Observer& observer) {
  for (const int disc : {index, other}) {
    bodies_.end(disc, Fate::unresolved, now, observer,
                "at this contact rounding of the positions hides where the other disc is: the "
                "discs are too small for so "
                "large a table, or have gone too far");
    contacts_.leave(disc);
  }
  look_again(index, other, now);
  look_again(other, index, now);
}

/// A disc goes on from its state after a contact.
void DiscContacts::start(int index, double way, Observer& observer) {
  Body& b = bodies_[index];
  b.particle.speed = std::sqrt(dot(b.state.velocity, b.state.velocity));
  b.flight = Flight{};
  b.state.wall = -1;
  if (b.particle.speed > 0.0) {
    if (!settle_on_wall(index, way, observer)) return contacts_.leave(index);
    flights_.begin(b);
  }
  enter(index, b.state.time);
}

/// The wall that a disc is at within rounding, after a flight of this length.
std::optional<DiscContacts::Touch> DiscContacts::touched_wall(const State& s, double way) const {
  const int walls = static_cast<int>(flights_.pieces().table.walls.size());
  const std::int64_t range = table_.lattice && walls > 0 ? 1 : 0;
  for (int w = 0; w < walls; ++w)
    for (std::int64_t m = -range; m <= range; ++m)
      for (std::int64_t n = -range; n <= range; ++n) {
        const Vector x =
            table_.lattice ? s.position - table_.lattice->translation({m, n}) : s.position;
        const geometry::PreparedCurve& curve = flights_.pieces().curve(w);
        // Position and time of the flight err by a few units of what they are made of.
        const double bound =
            32.0 * geometry::unit_roundoff * (norm_1(x) + norm_1(s.position) + curve.extent + way);
        const geometry::PreparedCurve::Frame frame = curve.settle(x);
        if (!(norm_1(frame.point - x) <= bound)) continue;
        const double u = curve.parameter(frame.point);
        if (norm_1(curve.point(u) - x) <= 2.0 * bound)
          return Touch{w, {m, n}, frame, u};  // not beyond its ends
      }
  return std::nullopt;
}

/// Puts a disc that is at a wall onto it; one that was pushed against it is reflected at once.
/// False if it ends there.
bool DiscContacts::settle_on_wall(int index, double way, Observer& observer) {
  Body& b = bodies_[index];
  const std::optional<Touch> touch = touched_wall(b.state, way);
  if (!touch) return true;
  const auto& [w, cell, frame, u] = *touch;
  b.state.wall = w;
  b.state.u = u;
  b.state.position = frame.point;
  b.state.cell.first += cell.first;
  b.state.cell.second += cell.second;
  const PieceTable& pieces = flights_.pieces();
  Sign inward = pieces.inward(w, u, b.state.velocity, frame.normal, flights_.counts());
  if (inward == Sign::positive) return true;
  const Time now = b.state.time;
  for (const int h : pieces.table.walls[at(w)].holes) {
    const Hole& hole = pieces.table.holes[at(h)];
    if (inward != Sign::negative || !(hole.from <= u && u < hole.to)) continue;
    b.hole = h;
    bodies_.end(index, Fate::escaped, now, observer);
    return false;
  }
  const Vector before = b.state.velocity;
  for (int i = 0; i < 2 && inward == Sign::negative; ++i) {
    b.state.velocity =
        geometry::reflected(b.state.velocity, frame.normal, frame.square, frame.k, 0.0);
    inward = pieces.inward(w, u, b.state.velocity, frame.normal, flights_.counts());
  }
  if (inward != Sign::positive) {
    bodies_.end(index, Fate::singular, now, observer);
    return false;
  }
  OnWalls(table_, observer).hit(bodies_.count_hit(index, b, b.state, before, 0.0, 1));
  if (!bodies_.reaches_limit(b)) return true;
  bodies_.end(index, Fate::capped, now, observer);
  return false;
}

}  // namespace carom::events
