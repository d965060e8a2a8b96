// Deviations over the hit of every lane that has made one in this sweep.
#include "carom/motion/transverse.hpp"
#include "lanes/free/tangent_pack.hpp"
#include "lanes/simd/real.hpp"
#include "motion/long_deviation.hpp"

namespace carom::lanes {
namespace {

using Vector = geometry::BasicVector<Real>;

CAROM_INLINE Real hits_of(const LanePack& pack, int lane) {
  return Real(pack.sweep) - load(pack.born + lane);
}
CAROM_INLINE Mask has_hit(const LanePack& pack, const TangentPack& tangents, int lane) {
  return load(pack.active + lane) > Real(0.0) && hits_of(pack, lane) != load(tangents.hits + lane);
}

unsigned long long due(const LanePack& pack, const TangentPack& tangents) {
  unsigned long long lanes = 0;
  for (int lane = 0; lane < pack.used; lane += width) {
    const Mask late = load(pack.high + lane) >= load(tangents.mark + lane);
    lanes |= static_cast<unsigned long long>(bits_of(late && has_hit(pack, tangents, lane)))
             << lane;
  }
  return lanes;
}

// Products of a column that is 0 without ellipses change no bit.
template <Reach reach, bool ellipses>
CAROM_INLINE Real kick_at(const TangentTable& t, const Real& piece, const Vector& x,
                          const Vector& v, const Real& square, const Real& omega) {
  const auto of = [&](const double* column) { return look_up<reach>(column, piece); };
  if constexpr (ellipses)
    return transverse_kick<Real>({of(t.center_x), of(t.center_y), of(t.xx), of(t.xy), of(t.yy),
                                  of(t.determinant), of(t.normal_x), of(t.normal_y)},
                                 x, v, square, omega);
  const Real bent = of(t.xx);
  return kick_of_circle_or_line<Real>({of(t.center_x), of(t.center_y)}, bent,
                                      {of(t.normal_x), of(t.normal_y)}, x, v, square, omega);
}

template <Reach reach, bool larmor, bool ellipses>
void carry(const TangentTable& __restrict table, const LanePack& __restrict pack,
           TangentPack& __restrict to) {
  for (int lane = 0; lane < pack.used; lane += width) {
    const Mask hit = has_hit(pack, to, lane);
    if (!any_of(hit)) continue;
    const Real high = load(pack.high + lane), low = load(pack.low + lane),
               square = load(to.square + lane);
    const Vector x{load(pack.x + lane), load(pack.y + lane)},
        v{load(pack.vx + lane), load(pack.vy + lane)};
    const Real omega = larmor ? load(to.omega + lane) : Real(0.0);
    // Pieces of single ones are not stored; those of lanes that have not hit may be none.
    const Real piece = table.pieces == 1 ? Real(0.0) : max(load(pack.piece + lane), Real(0.0));
    const Real kick = kick_at<reach, ellipses>(table, piece, x, v, square, omega);
    const Real duration = (high - load(to.high + lane)) + (low - load(to.low + lane));
    TransverseFlight<Real> flight{};
    if constexpr (larmor) {
      const Real first = load(pack.home_first + lane), second = load(pack.home_second + lane);
      const Real i = first - load(to.first + lane), j = second - load(to.second + lane);
      const Vector way{
          (x.x - load(to.x + lane)) + (i * table.lattice_x[0] + j * table.lattice_x[1]),
          (x.y - load(to.y + lane)) + (i * table.lattice_y[0] + j * table.lattice_y[1])};
      flight = flight_over<Real>(way, {load(to.vx + lane), load(to.vy + lane)},
                                 load(to.inverse_square + lane), omega);
      const auto keep = [&](const Real& number, double* column) {
        store_where(hit, number, column + lane);
      };
      keep(x.x, to.x), keep(x.y, to.y), keep(v.x, to.vx), keep(v.y, to.vy);
      keep(first, to.first), keep(second, to.second);
    }
    const Real unit = load(to.unit + lane);
    for (int k = 0; k < 2; ++k) {
      BasicTransverse<Real> w{load(to.place[k] + lane), load(to.rate[k] + lane)};
      w = larmor ? flown(w, flight) : flown(w, duration);
      w = reflected(w, kick);
      const Mask too_long = hit && abs(w.place) + abs(unit * w.rate) > Real(motion::long_deviation);
      if (any_of(too_long)) {
        constexpr double less = 1.0 / motion::long_deviation;
        where(too_long, w.place) = less * w.place;
        where(too_long, w.rate) = less * w.rate;
        store_where(too_long, load(to.shrunk[k] + lane) + 1.0, to.shrunk[k] + lane);
      }
      store_where(hit, w.place, to.place[k] + lane);
      store_where(hit, w.rate, to.rate[k] + lane);
    }
    store_where(hit, high, to.high + lane);
    store_where(hit, low, to.low + lane);
    store_where(hit, hits_of(pack, lane), to.hits + lane);
  }
}

template <bool larmor, bool ellipses>
TangentKernels kernels_of(const LaneTable& table) {
  return {due, table.pieces <= LaneTable::eight ? carry<reach_here(Reach::eight), larmor, ellipses>
                                                : carry<Reach::all, larmor, ellipses>};
}

}  // namespace

template <>
TangentKernels tangent_kernels<InstructionSet::CAROM_INSTRUCTION_SET>(const LaneTable& table,
                                                                      Turn turn) {
  if (turn == Turn::straight)
    return table.ellipses.any ? kernels_of<false, true>(table) : kernels_of<false, false>(table);
  return table.ellipses.any ? kernels_of<true, true>(table) : kernels_of<true, false>(table);
}

}  // namespace carom::lanes
