// Straight flights among the discs of a lattice, one in each cell: the disc that each meets,
// looked up by its direction and offset (next_disc_table.hpp).
#pragma once

#include "lanes/kernel/stages.hpp"
#include "lanes/simd/words.hpp"

namespace carom::lanes {
namespace {

/// A number whose lowest sixteen bits are the entry; any bits for a lane that does not begin on a
/// disc. Each quadrant about an axis has as many directions, by the coordinate along the other
/// axis.
CAROM_INLINE Real entry_of_sights(const LanePack& pack, int lane) {
  constexpr double quadrant = LaneTable::sight_directions, offsets = LaneTable::sight_offsets;
  const Vector way{load(pack.vx + lane), load(pack.vy + lane)};
  const Mask steep = abs(way.x) < abs(way.y);
  const Real small = choose(steep, way.x, way.y), big = choose(steep, way.y, way.x);
  Real middle = choose(steep, Real(2.5 * quadrant), Real(0.5 * quadrant));
  where(big < 0.0, middle) = middle + quadrant;
  const Real direction = rounded(fused(small, load(pack.directions + lane), middle));
  return fused(
      direction, Real(offsets),
      fused(load(pack.aside + lane), load(pack.offsets + lane), Real(0x1p52 + 0.5 * offsets)));
}

/// Copies what the walk over cells needs of a lane.
CAROM_INLINE void copy_walker(const LanePack& from, int lane, LanePack& to, int place) {
  const auto copy = [&](auto member) { (to.*member)[place] = (from.*member)[lane]; };
  copy(&LanePack::x);
  copy(&LanePack::y);
  copy(&LanePack::vx);
  copy(&LanePack::vy);
  copy(&LanePack::piece);
  copy(&LanePack::speed);
  copy(&LanePack::square_speed);
  copy(&LanePack::sides);
  copy(&LanePack::roots);
  copy(&LanePack::cell_first);
  copy(&LanePack::cell_second);
}

/// Those who begin off the discs go from cell to cell, side by side, to their first one.
template <Kind kind>
[[gnu::noinline]] void walk(const LaneTable& t, LanePack& pack, Stages& stages) {
  LanePack& few = *pack.walkers;
  int lanes[LanePack::lanes];
  few.used = 0;
  for (unsigned long long walking = pack.walking; walking != 0; walking &= walking - 1) {
    const int lane = __builtin_ctzll(walking);
    if (lane >= pack.used || pack.active[lane] == 0.0) {
      pack.walking &= ~(1ULL << lane);
      continue;
    }
    lanes[few.used] = lane;
    copy_walker(pack, lane, few, few.used++);
  }
  for (int place = few.used; place % width != 0; ++place) copy_walker(few, 0, few, place);
  Stages walked;
  if (t.edges == 4)
    choose_parallelograms<kind>(t, few, walked);
  else
    choose_hexagons<kind>(t, few, walked);
  // Who found a disc, who goes on, and who needs the scalar engine, also because lattice vectors
  // that are not the shortest count cells beyond a byte.
  unsigned long long found = 0, goes_on = 0;
  for (int place = 0; place < few.used; place += width) {
    found |= static_cast<unsigned long long>(bits_of(load(walked.decided, place))) << place;
    goes_on |= static_cast<unsigned long long>(bits_of(load(walked.gone, place))) << place;
  }
  for (int place = 0; place < few.used; ++place) {
    const int lane = lanes[place];
    if ((goes_on >> place & 1U) != 0) {
      pack.cell_first[lane] = walked.cell_first[place];
      pack.cell_second[lane] = walked.cell_second[place];
      continue;
    }
    const int first = static_cast<int>(walked.cell_first[place]),
              second = static_cast<int>(walked.cell_second[place]);
    const auto is_byte = [](int n) { return static_cast<unsigned>(n + 127) < 255u; };
    const bool meets = (found >> place & 1U) != 0 && is_byte(first) && is_byte(second);
    stages.cell[lane] =
        meets ? LaneTable::sight_of(first, second, first, second) : LaneTable::no_sight;
    pack.aside_home[lane] = pack.vx[lane] * (t.point_y[0] - pack.y[lane]) -
                            pack.vy[lane] * (t.point_x[0] - pack.x[lane]);
    pack.cell_first[lane] = pack.cell_second[lane] = 0.0;
    pack.piece[lane] = 0.0;
    pack.walking &= ~(1ULL << lane);
  }
}

/// What each lane sees: the cells of two discs.
template <Kind kind>
CAROM_INLINE void choose_by_sight(const LaneTable& t, LanePack& pack, Stages& stages) {
  for (int lane = 0; lane < pack.used; lane += width)
    store(entry_of_sights(pack, lane), stages.piece + lane);
  const int end = (pack.used + width - 1) / width * width;
#pragma GCC unroll 8
  for (int i = 0; i < end; ++i) {
    unsigned short entry;
    __builtin_memcpy(&entry, stages.piece + i, sizeof entry);
    unsigned seen = t.sights[entry];
    asm("" : "+r"(seen));  // one by one: put together in registers they take twice as long
    stages.cell[i] = seen;
  }
  if (pack.walking == 0) [[likely]]
    return;
  // A walk takes as long for a whole register as for one lane. Who waits stays where he is, far
  // from any disc.
  if (__builtin_popcountll(pack.walking) >= LanePack::fewest_walkers ||
      static_cast<long long>(pack.sweep) % LanePack::longest_wait == 0)
    walk<kind>(t, pack, stages);
  for (unsigned long long walking = pack.walking; walking != 0; walking &= walking - 1)
    stages.cell[__builtin_ctzll(walking)] = 0;
}

/// Sides of the lattice's vectors as flights see them.
struct Across {
  Real first, second;
  CAROM_INLINE Across(const LaneTable& t, const Vector& v)
      : first(fused(v.x, Real(t.lattice_y[0]), -v.y * t.lattice_x[0])),
        second(fused(v.x, Real(t.lattice_y[1]), -v.y * t.lattice_x[1])) {}
  CAROM_INLINE Real aside(const CellOf& cell, const Real& home) const {
    return fused(cell.first, first, fused(cell.second, second, home));
  }
};

/// Who passes the first disc takes the second one. Without a branch: few do, but a core that
/// guesses wrong loses all that it has begun.
CAROM_INLINE void pass_in_sight(const LaneTable& t, LanePack& pack, Stages& stages, int lane) {
  const Across across(t, {load(pack.vx + lane), load(pack.vy + lane)});
  const Words seen = sum_of_bytes(load(stages.cell + lane), load(pack.way + lane));
  const Real aside =
      across.aside({signed_byte<0>(seen), signed_byte<1>(seen)}, load(pack.aside_home + lane));
  store(second_where(abs(aside) > load(pack.passed + lane), seen), stages.cell + lane);
}
/// Where each flight begins, seen from the cell of that disc: it meets it, or passes it, too, and
/// goes on from there in the next sweep.
template <Kind kind>
CAROM_INLINE void look_from_sight(const LaneTable& t, LanePack& pack, Stages& stages, int lane) {
  const Vector origin{load(pack.x + lane), load(pack.y + lane)},
      v{load(pack.vx + lane), load(pack.vy + lane)};
  const Across across(t, v);
  const Words seen = load(stages.cell + lane);
  const CellOf cell{signed_byte<0>(seen), signed_byte<1>(seen)};
  const Real aside = across.aside(cell, load(pack.aside_home + lane));
  const Real way = way_of(cell), size = abs(aside);
  const Mask certain = way <= Real(LaneTable::farthest_cell),
             goes_on = certain && size > load(pack.passed + lane);
  const Real within =
      choose(way <= Real(LaneTable::near_cell), load(pack.cut + lane), load(pack.cut_far + lane));
  store(aside, pack.aside + lane);
  store(goes_on, stages.gone, lane);
  store(certain && size < within, stages.decided, lane);
  store(twice_where(goes_on, seen), pack.way + lane);
  const Vector start = seen_from(t, origin, cell);
  store(start.x, stages.start_x + lane);
  store(start.y, stages.start_y + lane);
}
template <Kind kind>
CAROM_INLINE void meet_in_sight(const LaneTable& t, const LanePack& pack, Stages& stages,
                                int lane) {
  View f = view_of<kind>(t, pack, lane);
  f.origin = {load(stages.start_x + lane), load(stages.start_y + lane)};
  const FractionOfTime at = meet_by_line<kind>(f, met_by<kind>(f, Real(0.0)));
  store(at.time, stages.time + lane);
  store(at.unit, stages.unit + lane);
}

}  // namespace
}  // namespace carom::lanes
