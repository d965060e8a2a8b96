#include "events/flight/free_flights.hpp"

#include <cmath>
#include <stdexcept>

#include "base/index.hpp"
#include "carom/base/elementary.hpp"

namespace carom::events {

using geometry::Vector;

FreeFlights::FreeFlights(const PieceTable& seen, const Table& inside, const ForceRegions& regions,
                         Bodies& bodies, std::shared_ptr<const Media> media)
    : finder_(seen),
      over_edges_(seen.discs_within && !seen.grid && !regions.by_range()),
      bodies_(bodies),
      regions_(regions),
      media_(std::move(media)),
      inside_(inside) {
  for (int r = 0; media_ && r < media_->size(); ++r)
    media_of_table_.push_back({HitFinder(media_->pieces_of(r)), nullptr});
  scattering_.any = scatters(media_ ? media_->table() : seen.table);
  scattering_.thermal = is_thermal(seen.table);
  plain_ = !media_ && !scattering_.any && !regions.any() &&
           (!seen.cells || over_edges_ || seen.grid) && seen.table.holes.empty();
  add_corners(pieces());
  for (int r = 0; media_ && r < media_->size(); ++r) add_corners(media_->pieces_of(r));
}

void FreeFlights::add_corners(const PieceTable& pieces) {
  const std::vector<Wall>& walls = pieces.table.walls;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Wall& w = walls[i];
    const bool none = (w.next == static_cast<int>(i) && geometry::is_closed(w.curve)) ||
                      is_passed(w) || is_passed(walls[base::at(w.previous)]);
    corners_.push_back(none ? 0
                       : w.corner > 0
                           ? w.corner
                           : pieces.exact->corner(w.previous, static_cast<int>(i)).order);
  }
}

bool FreeFlights::apply_apart(int index, Time now, Observer& observer) {
  return apply(index, now, observer);
}
void FreeFlights::predict(int index) {
  if (bodies_[index].region >= 0) return predict_in_region(index);
  predict(index, bodies_[index]);
}
void FreeFlights::schedule(int index) { schedule(index, bodies_[index]); }

void FreeFlights::check_speed(const Body& b) const {
  // The bounds of the filter count on the energy shell, as reflections keep it (circle_error).
  const double shell = b.particle.speed * b.particle.speed;
  if (!(std::fabs(dot(b.state.velocity, b.state.velocity) - shell) <=
        64.0 * geometry::unit_roundoff * shell))
    throw std::invalid_argument("the velocity's length is not the particle's speed");
}

void FreeFlights::set_speed(Body& b, double speed) {
  b.particle.speed = speed;
  b.shell = motion::energy_shell(speed);
  b.flight.square_speed = speed * speed;
}

void FreeFlights::begin(Body& b) const {
  b.flight = Flight();
  b.flight.omega = b.particle.omega;
  set_speed(b, b.particle.speed);
  const PieceTable& pieces = pieces_of(b.region);
  if (b.state.wall >= 0) {
    const int wall = b.state.wall - first_wall(b);
    const auto [point, normal, square, k] = pieces.curve(wall).frame(b.state.u);
    // A state that went on from a hit keeps its point; any other starts at the image of u.
    if (pieces.curve(wall).parameter(b.state.position) != b.state.u) b.state.position = point;
    DecisionCounts unused;
    if (pieces.inward(wall, b.state.u, b.state.velocity, normal, unused) != Sign::positive)
      throw std::invalid_argument("the velocity does not point into the domain");
    pieces.begin_on_wall(b.flight, wall, b.state.u, b.state.position, b.state.velocity);
  } else {
    b.flight.start = b.state.position;
    b.flight.velocity = b.state.velocity;
    pieces.begin(b.flight);
  }
}

void FreeFlights::begin_on_wall(Body& b, int wall, double u) const {
  set_speed(b, std::sqrt(dot(b.state.velocity, b.state.velocity)));
  b.flight.omega = b.particle.omega;
  pieces().begin_on_wall(b.flight, wall, u, b.state.position, b.state.velocity);
}

RandomStream::Block FreeFlights::words_of(int index, const Body& b, Purpose purpose) const {
  const int number = scattering_.numbers.empty() ? index : scattering_.numbers[base::at(index)];
  RandomStream::Block words;
  RandomStream::block(scattering_.seed, purpose, scattering_.trajectory,
                      static_cast<std::uint64_t>(number), b.hits, words);
  return words;
}

bool FreeFlights::lets_pass(int index, const Body& b, int hole) const {
  const double share = pieces().table.holes[base::at(hole)].transmission;
  return !(share < 1.0) ||
         RandomStream::uniform(words_of(index, b, Purpose::transmission)[0]) < share;
}

/// By Lambert's law the sine of the angle to the normal is uniform (docs/physics/scattering.md).
/// Where the velocity is not one into the domain, as at a corner, the next two numbers are tried.
Vector FreeFlights::scattered(int index, Body& b, const PieceTable& pieces,
                              const PieceTable::Landing& landing, Vector mirrored) {
  const Wall& wall = pieces.table.walls[base::at(landing.wall)];
  const bool rough = wall.roughness > 0.0, thermal = wall.temperature > 0.0;
  if (!(wall.specularity < 1.0) && !rough && !thermal) return mirrored;
  const RandomStream::Block words = words_of(index, b, Purpose::scattering);
  const Vector inward =
      (1.0 / std::sqrt(dot(landing.at.normal, landing.at.normal))) * landing.at.normal;
  if (thermal) {
    // The flux of a Maxwell distribution: v_n exp(-m v^2/2T).
    const auto speed = [&](std::uint64_t word) {
      const double u = 0.5 * (1.0 + RandomStream::symmetric(word));
      return std::sqrt(-2.0 * wall.temperature / b.particle.mass * elementary::log(u));
    };
    const double turn = elementary::cos(3.141592653589793 * RandomStream::symmetric(words[2]));
    const Vector after =
        speed(words[0]) * inward + (turn * speed(words[1])) * geometry::right(inward);
    if (pieces.inward(landing.wall, *landing.curve, landing.at.u, after, landing.at.normal,
                      counts_) != Sign::positive)
      return mirrored;
    set_speed(b, std::sqrt(dot(after, after)));
    return after;
  }
  if (!rough && RandomStream::uniform(words[0]) < wall.specularity) return mirrored;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const double random = RandomStream::symmetric(words[i]);
    Vector velocity;
    if (rough) {
      const auto [sine, cosine] = elementary::sincos(2.0 * wall.roughness * random);
      velocity = cosine * mirrored + sine * geometry::left(mirrored);
    } else {
      const double cosine = std::sqrt((1.0 - random) * (1.0 + random));
      velocity = b.particle.speed * (random * geometry::right(inward) + cosine * inward);
    }
    const Vector after = (1.0 + geometry::step_to_energy_shell(velocity, b.shell)) * velocity;
    if (pieces.inward(landing.wall, *landing.curve, landing.at.u, after, landing.at.normal,
                      counts_) == Sign::positive)
      return after;
  }
  return mirrored;
}

/// The flight ends on the edge of a support.
void FreeFlights::put_on_edge(Body& b, Time now, const PieceTable::Landing& landing) {
  b.state.wall = -1;
  b.state.position = landing.at.point;
  b.state.velocity = landing.velocity;
  b.state.cell.first += landing.cell.first;
  b.state.cell.second += landing.cell.second;
  b.state.time = now;
}

bool FreeFlights::contains(Vector point) {
  if (pieces().surely_inside(point)) return true;
  return outside_contains(point) || (media_ && place_in_region(point).region >= 0);
}

bool FreeFlights::outside_contains(Vector point) {
  if (!locator_) locator_ = std::make_unique<Locator>(inside_);
  return locator_->contains(point);
}

}  // namespace carom::events
