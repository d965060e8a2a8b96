// The hits of a body that is alone: a loop within the event loop, without its queue.
#include "base/fused_pair.hpp"
#include "events/flight/free_flights.hpp"

namespace carom::events {

/// Each number of the body is stored, as an observer may ask for it, but what the next hit needs is
/// taken from local variables: it does not wait for what was just stored. Of the flight only what
/// the state does not tell is stored: its cell on a lattice.
template <bool larmor, bool cells>
std::uint64_t FreeFlights::apply_hits(int index, double t_end, std::uint64_t most,
                                      Observer& observer) {
  Body& b = bodies_[index];
  struct Row {
    FreeFlights& flights;
    const int index;
    Body& b;
    std::uint64_t hits = 0;
    ~Row() {  // also where an observer throws
      if (hits == 0) return;
      flights.begin_off_joints(b);
      if constexpr (!cells) b.flight.start_piece = b.state.wall;
      flights.schedule(index, b);
    }
  } row{*this, index, b};
  // Without the processor's instruction, `apply` is as good.
  while (row.hits < most && b.ahead.kind == Ahead::Kind::wall && base::fuses()) {
    const double duration = b.ahead.duration;
    const Time now = b.state.time + duration;
    if (!(now.high < t_end) && now > Time(t_end)) break;
    Flight flight;
    flight.omega = larmor ? b.flight.omega : 0.0;
    flight.square_speed = b.flight.square_speed;
    flight.start = b.state.position;
    flight.velocity = b.state.velocity;
    const int wall = b.ahead.piece;
    // Among many walls one may reach into other cells.
    if constexpr (cells)
      if (pieces().grid &&
          (wall >= static_cast<int>(pieces().table.walls.size()) || !pieces().piece(wall).within))
        break;
    const geometry::PreparedCurve& curve = pieces().curve(wall);
    geometry::Vector before, origin = flight.start;
    if constexpr (cells) {
      const geometry::Cell cell = b.flight.cell;
      if ((cell.first | cell.second) != 0)
        origin = pieces().table.lattice->seen_from(cell, flight.start);
    }
    geometry::PreparedCurve::Arrival at;
    curve.arrive(PieceTable::end_of(flight, b.ahead, origin, before), before, at, b.ahead.u);
    base::fuses_surely();
    const geometry::Vector after = mirrored(b, before, at);
    if (pieces().inward_off_joints(curve, after, at.normal) != Sign::positive ||
        bodies_.next_reaches_limit(b))
      break;
    ++counts_.filter;
    put_on_wall(b, wall, now, at, after);
    if constexpr (cells) {
      b.state.cell.first += b.flight.cell.first;
      b.state.cell.second += b.flight.cell.second;
    }
    const HitEvent& hit = bodies_.count_hit(index, b, b.state, before, duration, 1);
    PieceTable::begin_off_joints(flight, wall, curve, at.u, at.point, after);
    Ahead ahead;
    base::fuses_surely();
    bool found;
    if constexpr (cells)
      found = !pieces().grid && finder_.over_edges(flight, ahead, counts_);
    else
      found = finder_.next_in_convex(flight, ahead, counts_);
    if constexpr (cells) {
      b.flight.cell.first = flight.cell.first;
      b.flight.cell.second = flight.cell.second;
      b.flight.entry = flight.entry;
      b.flight.start_piece = flight.start_piece;
    }
    if (found) {
      b.ahead = ahead;
    } else {
      begin_off_joints(b);
      if constexpr (!cells) b.flight.start_piece = wall;
      finder_.next_in_any(b.flight, b.ahead, counts_);
    }
    ++row.hits;
    observer.hit(hit);
  }
  return row.hits;
}

std::uint64_t FreeFlights::apply_hits(int index, double t_end, std::uint64_t most,
                                      Observer& observer) {
  if (!plain_) return 0;
  const bool larmor = bodies_[index].flight.omega != 0.0;
  if (pieces().cells) return larmor ? 0 : apply_hits<false, true>(index, t_end, most, observer);
  return larmor ? apply_hits<true, false>(index, t_end, most, observer)
                : apply_hits<false, false>(index, t_end, most, observer);
}

}  // namespace carom::events
