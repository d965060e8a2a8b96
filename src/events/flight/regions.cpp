// Flights from one region of a table into another, through a wall that both see
// (docs/physics/regions.md).
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/index.hpp"
#include "carom/base/elementary.hpp"
#include "carom/events/medium.hpp"
#include "events/flight/free_flights.hpp"

namespace carom::events {

using base::at;
using geometry::Vector;

/// The region's particle, and its energy shell; the state stays.
void FreeFlights::put_into(Body& b, int region) const {
  b.region = region;
  b.particle = in_region(media_->table(), b.outside, region);
  b.flight.omega = b.particle.omega;
  set_speed(b, b.particle.speed);
}

void FreeFlights::enter(Body& b) {
  if (!media_) return;
  b.outside = b.particle;
  int region = -1;
  if (b.state.wall >= 0) {
    region = region_of(media_->table(), b.state.wall);
  } else if (!outside_contains(b.state.position)) {
    const InRegion found = place_in_region(b.state.position);
    region = found.region;
    b.state.position = found.position;
    b.state.cell.first += found.cell.first;
    b.state.cell.second += found.cell.second;
  }
  put_into(b, region);
  if (!(b.particle.speed > 0.0))
    throw std::invalid_argument("the potential there is higher than the kinetic energy");
  const auto has_speed = [&](double speed) {
    const double shell = speed * speed;
    return std::fabs(dot(b.state.velocity, b.state.velocity) - shell) <=
           64.0 * geometry::unit_roundoff * shell;
  };
  if (region < 0 || has_speed(b.particle.speed) || !has_speed(b.outside.speed)) return;
  const Vector scaled = (b.particle.speed / b.outside.speed) * b.state.velocity;
  b.state.velocity = (1.0 + geometry::step_to_energy_shell(scaled, b.shell)) * scaled;
}

/// On a lattice the obstacle of the point may begin in another cell: its walls are those of that
/// one.
FreeFlights::InRegion FreeFlights::place_in_region(Vector point) {
  for (int r = 0; r < media_->size(); ++r) {
    Medium& medium = media_of_table_[at(r)];
    if (!medium.locator) medium.locator = std::make_unique<Locator>(media_->walls_of(r));
    for (const geometry::Cell& cell : pieces().offsets) {
      const Vector seen = pieces().cells ? pieces().table.lattice->seen_from(cell, point) : point;
      if (medium.locator->contains(seen)) return {r, cell, seen};
    }
  }
  return {-1, {}, point};
}

void FreeFlights::predict_in_region(int index) {
  Body& b = bodies_[index];
  media_of_table_[at(b.region)].finder.next(b.flight, b.ahead, counts_);
  schedule(index, b);
}

namespace {

/// The fraction of the hits that a region mirrors although they could pass, of the parts of the
/// momenta across the edge, before and behind it, and of that along it. NaN: the formula gives
/// none.
double mirrored_fraction(const Region& region, double across, double beyond, double along,
                         double here, double there) {
  using enum Region::Reflection;
  if (region.reflection == none) return 0.0;
  if (region.reflection == typed) {
    along = std::fabs(along);
    const double fraction = region.fraction->value(std::array{
        elementary::atan2(along, across), elementary::atan2(along, beyond), there / here});
    return fraction >= 0.0 && fraction <= 1.0 ? fraction : std::numeric_limits<double>::quiet_NaN();
  }
  if (region.reflection == p) {
    across /= here * here;
    beyond /= there * there;
  }
  const double amplitude = (across - beyond) / (across + beyond);
  return amplitude * amplitude;
}

}  // namespace

/// The particle goes on behind the wall, if it can: then it is there, on the wall's other side.
/// Momenta along the wall stay.
FreeFlights::Passage FreeFlights::cross(int index, Body& b, const PieceTable::Landing& landing) {
  const Table& table = media_->table();
  const int to = media_->twin(first_wall(b) + landing.wall);
  const int beyond = region_of(table, to);
  const double here = momentum_in(table, b.outside, b.region),
               there = momentum_in(table, b.outside, beyond);
  const double next_speed = in_region(table, b.outside, beyond).speed;
  const Region& region = table.regions[at(is_inner_side(table, to) ? beyond : b.region)];
  Vector after = landing.velocity;
  if (here != there || region.fraction) {
    const Vector inward =
        (1.0 / std::sqrt(dot(landing.at.normal, landing.at.normal))) * landing.at.normal;
    const Vector along = geometry::right(inward);
    const double unit = here / b.particle.speed;
    const double tangential = unit * dot(along, landing.velocity);
    const double normal = -unit * dot(inward, landing.velocity);
    const double square = (there - tangential) * (there + tangential);
    if (!(square > 0.0)) return Passage::mirrored;  // total reflection
    const double beyond_normal = std::sqrt(square);
    const double fraction =
        mirrored_fraction(region, normal, beyond_normal, tangential, here, there);
    if (std::isnan(fraction)) return Passage::unknown;
    if (fraction > 0.0 &&
        RandomStream::uniform(words_of(index, b, Purpose::scattering)[0]) < fraction)
      return Passage::mirrored;
    if (here != there) after = (next_speed / there) * (tangential * along - beyond_normal * inward);
  }
  const PieceTable& pieces = pieces_of(beyond);
  const int wall = to - media_->first_wall(beyond);
  const geometry::PreparedCurve& curve = pieces.curve(wall);
  PieceTable::Landing on;
  curve.arrive(landing.at.point, after, on.at, curve.last() - landing.at.u);
  after = (1.0 + geometry::step_to_energy_shell(after, motion::energy_shell(next_speed))) * after;
  // Rounding may have turned a velocity along the wall back.
  if (pieces.inward(wall, curve, on.at.u, after, on.at.normal, counts_) != Sign::positive)
    return Passage::mirrored;
  put_into(b, beyond);
  b.state.wall = to;
  b.state.u = on.at.u;
  b.state.position = on.at.point;
  b.state.velocity = after;
  pieces.begin_on_wall(b.flight, wall, curve, on.at.u, on.at.point, after);
  return Passage::passed;
}

void FreeFlights::pass(int index, Time now, Observer& observer) {
  Body& b = bodies_[index];
  const PieceTable& pieces = pieces_of(b.region);
  const int first = first_wall(b);
  PieceTable::Landing landing;
  pieces.land(b.flight, b.ahead, landing, counts_);
  const bool edge = media_->twin(first + landing.wall) >= 0;
  if (edge && b.ahead.kind == Ahead::Kind::joint)
    return bodies_.end(index, Fate::singular, now, observer, "a corner of a region");
  const Vector before = landing.velocity;
  const Passage passage = edge ? cross(index, b, landing) : Passage::mirrored;
  if (passage == Passage::unknown)
    return bodies_.end(index, Fate::unresolved, now, observer,
                       "the formula of `reflection` gives no number from 0 to 1 there");
  if (passage == Passage::mirrored) {
    meet(index, b, now, observer, pieces, first, landing);
    return;
  }
  b.state.cell.first += landing.cell.first;
  b.state.cell.second += landing.cell.second;
  b.state.time = now;
  const HitEvent& hit = bodies_.count_hit(index, b, b.state, before, b.ahead.duration, 1);
  observer.hit(hit);
  if (bodies_.reaches_limit(b)) return bodies_.end(index, Fate::capped, now, observer);
  predict(index);
}

}  // namespace carom::events
