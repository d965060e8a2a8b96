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
CAROM_INLINE Real entry_of_next_disc(const LanePack& pack, int lane) {
  constexpr double quadrant = LaneTable::disc_directions, offsets = LaneTable::disc_offsets;
  const Vector v{load(pack.vx + lane), load(pack.vy + lane)};
  const Mask steep = abs(v.x) < abs(v.y);
  const Real small = choose(steep, v.x, v.y), big = choose(steep, v.y, v.x);
  Real middle = choose(steep, Real(2.5 * quadrant), Real(0.5 * quadrant));
  where(big < 0.0, middle) = middle + quadrant;
  const Real direction = rounded(fused(small, load(pack.directions + lane), middle));
  return fused(
      direction, Real(offsets),
      fused(load(pack.aside + lane), load(pack.offsets + lane), Real(0x1p52 + 0.5 * offsets)));
}

/// Copies what the search for a first disc needs of a lane.
CAROM_INLINE void copy_lane(const LanePack& from, int lane, LanePack& to, int place) {
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

/// Takes the lanes that began off the discs a few cells on, to their first disc. They are gathered
/// in a pack of their own.
template <Kind kind>
[[gnu::noinline]] void search_first_disc(const LaneTable& t, LanePack& pack, Stages& stages) {
  LanePack& few = *pack.search_pack;
  int lanes[LanePack::lanes];
  few.used = 0;
  for (unsigned long long searching = pack.searching; searching != 0; searching &= searching - 1) {
    const int lane = __builtin_ctzll(searching);
    if (lane >= pack.used || pack.active[lane] == 0.0) {
      pack.searching &= ~(1ULL << lane);
      continue;
    }
    lanes[few.used] = lane;
    copy_lane(pack, lane, few, few.used++);
  }
  for (int place = few.used; place % width != 0; ++place) copy_lane(few, 0, few, place);
  Stages reached;
  if (t.edges == 4)
    choose_parallelograms<kind>(t, few, reached);
  else
    choose_hexagons<kind>(t, few, reached);
  // A lane has found its disc, or goes on, or needs the scalar engine: because that is not certain,
  // or because the cell does not fit into a byte (lattice vectors may be long for their cell).
  unsigned long long found = 0, goes_on = 0;
  for (int place = 0; place < few.used; place += width) {
    found |= static_cast<unsigned long long>(bits_of(load(reached.decided, place))) << place;
    goes_on |= static_cast<unsigned long long>(bits_of(load(reached.gone, place))) << place;
  }
  for (int place = 0; place < few.used; ++place) {
    const int lane = lanes[place];
    if ((goes_on >> place & 1U) != 0) {
      pack.cell_first[lane] = reached.cell_first[place];
      pack.cell_second[lane] = reached.cell_second[place];
      continue;
    }
    const int first = static_cast<int>(reached.cell_first[place]),
              second = static_cast<int>(reached.cell_second[place]);
    const auto is_byte = [](int n) { return static_cast<unsigned>(n + 127) < 255u; };
    const bool meets = (found >> place & 1U) != 0 && is_byte(first) && is_byte(second);
    stages.cell[lane] =
        meets ? LaneTable::two_discs(first, second, first, second) : LaneTable::no_discs;
    pack.aside_home[lane] = pack.vx[lane] * (t.point_y[0] - pack.y[lane]) -
                            pack.vy[lane] * (t.point_x[0] - pack.x[lane]);
    pack.cell_first[lane] = pack.cell_second[lane] = 0.0;
    pack.piece[lane] = 0.0;
    pack.searching &= ~(1ULL << lane);
  }
}

/// Looks up the cells of the two discs that each flight may meet next.
template <Kind kind>
CAROM_INLINE void choose_next_disc(const LaneTable& t, LanePack& pack, Stages& stages) {
  for (int lane = 0; lane < pack.used; lane += width)
    store(entry_of_next_disc(pack, lane), stages.piece + lane);
  const int end = (pack.used + width - 1) / width * width;
#pragma GCC unroll 8
  for (int i = 0; i < end; ++i) {
    unsigned short entry;
    __builtin_memcpy(&entry, stages.piece + i, sizeof entry);
    unsigned discs = t.next_discs[entry];
    asm("" : "+r"(discs));  // one by one: gathered into registers they take twice as long
    stages.cell[i] = discs;
  }
  if (pack.searching == 0) [[likely]]
    return;
  // A search takes as long for a whole register as for one lane, so lanes wait for others. A lane
  // that waits is looked up at a place far from any disc, and stays where it is.
  if (__builtin_popcountll(pack.searching) >= LanePack::fewest_searching ||
      static_cast<long long>(pack.sweep) % LanePack::longest_wait == 0)
    search_first_disc<kind>(t, pack, stages);
  for (unsigned long long searching = pack.searching; searching != 0; searching &= searching - 1)
    stages.cell[__builtin_ctzll(searching)] = 0;
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

/// A flight that passes the first disc takes the second one. Without a branch: few do, but a core
/// that guesses wrong loses all that it has begun.
CAROM_INLINE void pass_first_disc(const LaneTable& t, LanePack& pack, Stages& stages, int lane) {
  const Across across(t, {load(pack.vx + lane), load(pack.vy + lane)});
  const Words discs = sum_of_bytes(load(stages.cell + lane), load(pack.passed_cell + lane));
  const Real aside =
      across.aside({signed_byte<0>(discs), signed_byte<1>(discs)}, load(pack.aside_home + lane));
  store(second_where(abs(aside) > load(pack.passed + lane), discs), stages.cell + lane);
}
/// Where each flight begins, discs from the cell of that disc. The flight meets the disc, or passes
/// it, too, and goes on from there in the next sweep.
template <Kind kind>
CAROM_INLINE void look_from_next_disc(const LaneTable& t, LanePack& pack, Stages& stages,
                                      int lane) {
  const Vector origin{load(pack.x + lane), load(pack.y + lane)},
      v{load(pack.vx + lane), load(pack.vy + lane)};
  const Across across(t, v);
  const Words discs = load(stages.cell + lane);
  const CellOf cell{signed_byte<0>(discs), signed_byte<1>(discs)};
  const Real aside = across.aside(cell, load(pack.aside_home + lane));
  const Real cells = cells_from_home(cell), size = abs(aside);
  const Mask certain = cells <= Real(LaneTable::farthest_cell),
             goes_on = certain && size > load(pack.passed + lane);
  const Real within =
      choose(cells <= Real(LaneTable::near_cell), load(pack.cut + lane), load(pack.cut_far + lane));
  store(aside, pack.aside + lane);
  store(goes_on, stages.gone, lane);
  store(certain && size < within, stages.decided, lane);
  store(twice_where(goes_on, discs), pack.passed_cell + lane);
  const Vector start = seen_from(t, origin, cell);
  store(start.x, stages.start_x + lane);
  store(start.y, stages.start_y + lane);
}
template <Kind kind>
CAROM_INLINE void meet_next_disc(const LaneTable& t, const LanePack& pack, Stages& stages,
                                 int lane) {
  View f = view_of<kind>(t, pack, lane);
  f.origin = {load(stages.start_x + lane), load(stages.start_y + lane)};
  const FractionOfTime at = meet_by_line<kind>(f, met_by<kind>(f, Real(0.0)));
  store(at.time, stages.time + lane);
  store(at.unit, stages.unit + lane);
}

}  // namespace
}  // namespace carom::lanes
