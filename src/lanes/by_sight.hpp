// Straight flights among the discs of a lattice, one in each cell: the disc that each meets, looked up by its direction and offset
// (discs_in_sight.hpp). Included by kernel.hpp inside the namespace of its instruction set.

/// A number whose lowest sixteen bits are the entry; any bits for a lane that does not begin on a disc. Each quadrant about an axis has as
/// many directions, by the coordinate along the other axis.
INLINE Real entry_of_sights(const LaneTable& t, const LanePack& pack, int lane) {
  constexpr double quadrant = LaneTable::sight_directions, offsets = LaneTable::sight_offsets;
  const Vector way{load(pack.vx + lane), load(pack.vy + lane)};
  const Real dx = t.point_x[0] - load(pack.x + lane), dy = t.point_y[0] - load(pack.y + lane);
  const Real aside = fused(way.x, dy, -way.y * dx);
  const Mask steep = abs(way.x) < abs(way.y);
  const Real small = choose(steep, way.x, way.y), big = choose(steep, way.y, way.x);
  Real middle = choose(steep, Real(2.5 * quadrant), Real(0.5 * quadrant));
  where(big < 0.0, middle) = middle + quadrant;
  const Real direction = rounded(fused(small, load(pack.directions + lane), middle));
  return fused(direction, Real(offsets), fused(aside, load(pack.offsets + lane), Real(0x1p52 + 0.5 * offsets)));
}

/// Copies what the walk over cells needs of a lane.
INLINE void copy_walker(const LanePack& from, int lane, LanePack& to, int place) {
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

/// Those for whom the table is open, or who are on their way already, go from cell to cell, side by side.
template <class Kind>
[[gnu::noinline]] void walk(const LaneTable& t, LanePack& pack, Stages& stages) {
  LanePack& few = *pack.walkers;
  int lanes[LanePack::lanes];
  few.used = 0;
  for (unsigned long long waiting = stages.waiting; waiting != 0; waiting &= waiting - 1) {
    const int lane = __builtin_ctzll(waiting);
    if (lane >= pack.used || pack.active[lane] == 0.0) {
      pack.on_way &= ~(1ULL << lane);
      continue;
    }
    lanes[few.used] = lane;
    copy_walker(pack, lane, few, few.used++);
  }
  for (int place = few.used; place % width != 0; ++place) copy_walker(few, 0, few, place);
  Stages walked;
  if (t.edges == 4)
    choose_parallelograms<Kind>(t, few, walked);
  else
    choose_hexagons<Kind>(t, few, walked);
  // Who found a disc, who goes on, and who needs the scalar engine, also because lattice vectors that are not the shortest count cells
  // beyond a byte: without branches, for no core guesses them.
  unsigned long long found = 0, goes_on = 0;
  for (int place = 0; place < few.used; place += width) {
    found |= static_cast<unsigned long long>(bits_of(load(walked.decided, place))) << place;
    goes_on |= static_cast<unsigned long long>(bits_of(load(walked.gone, place))) << place;
  }
  for (int place = 0; place < few.used; ++place) {
    const int lane = lanes[place];
    const int first = static_cast<int>(walked.cell_first[place]), second = static_cast<int>(walked.cell_second[place]);
    const auto is_byte = [](int n) -> unsigned long long { return static_cast<unsigned>(n + 127) < 255u; };
    const unsigned long long fits = is_byte(first) & is_byte(second);
    const unsigned long long on = (goes_on >> place & 1U) << lane, ends = (~((found >> place & fits) | goes_on >> place) & 1U) << lane;
    const unsigned long long bit = 1ULL << lane;
    stages.cell[lane] = LaneTable::sight_of(first, second, first, second);
    stages.waiting = (stages.waiting & ~bit) | on;
    stages.undecided |= ends;
    pack.on_way = (pack.on_way & ~bit) | on;
    const double still = counted[goes_on >> place & 1U];
    pack.cell_first[lane] = still * walked.cell_first[place];
    pack.cell_second[lane] = still * walked.cell_second[place];
    pack.piece[lane] = 0.0;
  }
}

/// The cell of the disc that each lane meets.
template <class Kind>
INLINE void choose_by_sight(const LaneTable& t, LanePack& pack, Stages& stages) {
  for (int lane = 0; lane < pack.used; lane += width) store(entry_of_sights(t, pack, lane), stages.piece + lane);
  const int end = (pack.used + width - 1) / width * width;
#pragma GCC unroll 8
  for (int i = 0; i < end; ++i) {
    unsigned short entry;
    __builtin_memcpy(&entry, stages.piece + i, sizeof entry);
    unsigned seen = t.sights[entry];
    asm("" : "+r"(seen));  // one by one: put together in registers they take twice as long
    stages.cell[i] = seen;
  }
  stages.waiting = equal(stages.cell, end, LaneTable::open_sight) | pack.on_way;
  stages.undecided = 0;
  // A walk takes as long for a whole register as for one lane.
  if (__builtin_popcountll(stages.waiting) >= LanePack::fewest_walkers ||
      (stages.waiting != 0 && static_cast<long long>(pack.sweep) % LanePack::longest_wait == 0))
    walk<Kind>(t, pack, stages);
}

/// Where each flight begins, seen from the cell of the disc that the table names, or of the one behind it if it passes that.
template <class Kind>
INLINE void look_from_sight(const LaneTable& t, const LanePack& pack, Stages& stages, int lane) {
  const View f = view_of<Kind>(t, pack, lane);
  unsigned* cell = stages.cell + lane;
  // Both without a branch: few registers need the second, but a core that guesses wrong loses all that it has begun.
  const Vector start = seen_from(t, f.origin, {signed_byte<0>(cell), signed_byte<1>(cell)});
  const Vector then = seen_from(t, f.origin, {signed_byte<2>(cell), signed_byte<3>(cell)});
  const Real aside = abs(cross(f.velocity, start - Vector{Real(t.point_x[0]), Real(t.point_y[0])})) * load(pack.offsets + lane);
  const Mask passes = aside > t.sight_far;
  take_second(passes, cell);
  store(choose(passes, then.x, start.x), stages.start_x + lane);
  store(choose(passes, then.y, start.y), stages.start_y + lane);
  const Mask waits = mask_of(static_cast<unsigned>((stages.waiting | stages.undecided) >> lane));
  store((passes || aside < t.sight_near) && !waits, stages.decided, lane);
}
template <class Kind>
INLINE void meet_in_sight(const LaneTable& t, const LanePack& pack, Stages& stages, int lane) {
  View f = view_of<Kind>(t, pack, lane);
  f.origin = {load(stages.start_x + lane), load(stages.start_y + lane)};
  const FractionOfTime at = meet_by_line<Kind>(f, met_by<Kind>(f, Real(0.0)));
  store(at.time, stages.time + lane);
  store(at.unit, stages.unit + lane);
}
