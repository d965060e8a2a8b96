// The hits of a body that is alone: a loop within the event loop, without its queue.
#include <algorithm>

#include "base/fused_pair.hpp"
#include "events/flight/free_flights.hpp"

// Compiled for processors that fuse products, the loop needs fewer moves; others do not run it.
#if defined(__x86_64__) && !defined(__FMA__)
#define CAROM_FUSING [[gnu::target("fma")]]
#else
#define CAROM_FUSING
#endif

namespace carom::events {

/// Where a body flies alone: in_four is in_convex where the enclosure meets_four.
enum class FreeFlights::Alone { in_four, in_convex, with_field, on_lattice };

/// What follows a row of hits. By value: numbers that are referred to live in memory.
template <FreeFlights::Alone alone>
[[gnu::noinline]] void FreeFlights::finish_hits(int index, Body& b, Ahead ahead,
                                                DecisionCounts counts, std::uint64_t hits) {
  counts_ += counts;
  if (hits == 0) return;
  b.ahead = ahead;
  begin_off_joints(b);
  if constexpr (alone != Alone::on_lattice) b.flight.start_piece = b.state.wall;
  schedule(index, b);
}

/// Each number of the body is stored, as an observer may ask for it, but what the next hit needs is
/// taken from local variables: it does not wait for what was just stored. Of the flight only what
/// the state does not tell is stored: its cell on a lattice.
template <FreeFlights::Alone alone>
CAROM_FUSING std::uint64_t FreeFlights::apply_hits(int index, double t_end, std::uint64_t most,
                                                   Observer& observer) {
  constexpr bool larmor = alone == Alone::with_field, cells = alone == Alone::on_lattice,
                 four = alone == Alone::in_four;
  Body& b = bodies_[index];
  Flight flight;
  flight.omega = larmor ? b.flight.omega : 0.0;
  flight.square_speed = b.flight.square_speed;
  flight.start = b.state.position;
  flight.velocity = b.state.velocity;
  Time time = b.state.time;
  Ahead ahead = b.ahead;
  DecisionCounts counts;
  std::uint64_t hits = 0;
  struct Row {
    FreeFlights& flights;
    const int index;
    Body& b;
    const Ahead& ahead;
    const DecisionCounts& counts;
    const std::uint64_t& hits;
    // Also where an observer throws. Inlined, for the same reason.
    [[gnu::always_inline]] ~Row() { flights.finish_hits<alone>(index, b, ahead, counts, hits); }
  } row{*this, index, b, ahead, counts, hits};
  most = std::min(most, bodies_.hits_below_limit(b));
  bodies_.expect_hits(index, b.state.cell);
  while (hits < most && ahead.kind == Ahead::Kind::wall) {
    const double duration = ahead.duration;
    const Time now = time + duration;
    if (!(now.high < t_end) && now > Time(t_end)) break;
    const int wall = ahead.piece;
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
    base::fuses_surely();
    const geometry::Vector end = PieceTable::end_of(flight, ahead, origin, before);
    geometry::PreparedCurve::Arrival at;
    if constexpr (four) {
      if (!curve.arrive_on_segment(end, before, at)) break;
    } else {
      curve.arrive(end, before, at, ahead.u);
    }
    base::fuses_surely();
    const geometry::Vector after = mirrored(b, before, at);
    if (pieces().inward_off_joints(curve, after, at.normal) != Sign::positive) break;
    ++counts.filter;
    put_on_wall(b, wall, now, at, after);
    if constexpr (cells) {
      b.state.cell.first += b.flight.cell.first;
      b.state.cell.second += b.flight.cell.second;
    }
    const HitEvent& hit = bodies_.count_expected<cells>(b, before, duration);
    PieceTable::begin_off_joints(flight, wall, curve, at.u, at.point, after);
    base::fuses_surely();
    bool found;
    if constexpr (four)
      found = finder_.next_in_four(flight, ahead, counts);
    else if constexpr (cells)
      found = !pieces().grid && finder_.over_edges(flight, ahead, counts);
    else
      found = finder_.next_in_convex(flight, ahead, counts);
    if constexpr (cells) {
      b.flight.cell.first = flight.cell.first;
      b.flight.cell.second = flight.cell.second;
      b.flight.entry = flight.entry;
      b.flight.start_piece = flight.start_piece;
    }
    if (!found) {
      begin_off_joints(b);
      if constexpr (!cells) b.flight.start_piece = wall;
      finder_.next_in_any(b.flight, b.ahead, counts_);
      ahead = b.ahead;
    }
    time = now;
    ++hits;
    observer.hit(hit);
  }
  return hits;
}

std::uint64_t FreeFlights::apply_hits(int index, double t_end, std::uint64_t most,
                                      Observer& observer) {
  // Without the processor's instruction, `apply` is as good.
  if (!plain_ || !base::fuses()) return 0;
  const bool larmor = bodies_[index].flight.omega != 0.0;
  if (pieces().cells)
    return larmor ? 0 : apply_hits<Alone::on_lattice>(index, t_end, most, observer);
  if (larmor) return apply_hits<Alone::with_field>(index, t_end, most, observer);
  return pieces().convex && pieces().enclosure.meets_four()
             ? apply_hits<Alone::in_four>(index, t_end, most, observer)
             : apply_hits<Alone::in_convex>(index, t_end, most, observer);
}

}  // namespace carom::events
