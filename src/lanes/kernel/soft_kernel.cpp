// Steps of particles under forces.
#include "events/step/step_hull.hpp"
#include "lanes/simd/real.hpp"
#include "lanes/soft/soft_pack.hpp"

namespace carom::lanes {
namespace {

using Vector = geometry::BasicVector<Real>;

/// Lanes that are done together: their numbers stay in the first cache.
constexpr int most_together = 16;
struct Together {
  int count = 0;
  alignas(64) double i[most_together], j[most_together], dx[most_together], dy[most_together];
  double X[most_together], Y[most_together], by_X[most_together], by_Y[most_together];
  double fx[8][most_together], fy[8][most_together];  // of near copies: eight running sums
  double near_x[8][most_together], near_y[8][most_together], r[8][most_together];
  alignas(64) double e[8 * most_together];
  const double* node[most_together];
};

/// As forces::lattice_sum::totals.
CAROM_INLINE Real total(const double s[8][most_together], int lane) {
  return ((load(s[0] + lane) + load(s[4] + lane)) + (load(s[2] + lane) + load(s[6] + lane))) +
         ((load(s[1] + lane) + load(s[5] + lane)) + (load(s[3] + lane) + load(s[7] + lane)));
}

/// Up to eight near copies, from number `from` on.
CAROM_INLINE void add_near(const SoftForces& forces, const forces::LatticeSum& t, int from,
                           Together& g) {
  const int copies = t.near - from < 8 ? t.near - from : 8;
  for (int lane = 0; lane < g.count; ++lane) {
    const double *x = g.node[lane] + from, *y = x + t.padded_near;
    for (int k = 0; k < copies; ++k) {
      g.near_x[k][lane] = g.dx[lane] + x[k];
      g.near_y[k][lane] = g.dy[lane] + y[k];
    }
  }
  for (int k = 0; k < copies; ++k)
    for (int lane = 0; lane < g.count; lane += width) {
      const Real dx = load(g.near_x[k] + lane), dy = load(g.near_y[k] + lane);
      Real r(0.0), e;
      if (t.fermi)
        forces::lattice_sum::fermi_exponent(t, dx, dy, r, e);
      else
        e = forces::lattice_sum::gaussian_exponent(t, dx, dy);
      store(r, g.r[k] + lane);
      store(e, g.e + k * g.count + lane);
    }
  forces.exp(g.e, static_cast<std::size_t>(copies * g.count));
  for (int k = 0; k < 8; ++k)
    for (int lane = 0; lane < g.count; lane += width) {
      Real fx(0.0), fy(0.0);
      if (k < copies) {
        const Real e = load(g.e + k * g.count + lane);
        Real q = e, f = e;
        if (t.fermi) forces::lattice_sum::fermi_bump(load(g.r[k] + lane), e, q, f);
        fx = f * load(g.near_x[k] + lane);
        fy = f * load(g.near_y[k] + lane);
      }
      store(load(g.fx[k] + lane) + fx, g.fx[k] + lane);
      store(load(g.fy[k] + lane) + fy, g.fy[k] + lane);
    }
}

/// LatticeBumps::add_force, for many.
CAROM_INLINE void add_lattice(const SoftForces& forces, const forces::LatticeField& field,
                              SoftPack& pack) {
  const forces::LatticeSum& t = field.sum;
  Together g;
  for (int first = 0; first < pack.count; first += most_together) {
    g.count = pack.count - first < most_together ? pack.count - first : most_together;
    for (int lane = 0; lane < g.count; lane += width) {
      const forces::GridPoint<Real> p =
          forces::lattice_sum::locate(t, load(pack.x + first + lane), load(pack.y + first + lane));
      store(p.i, g.i + lane);
      store(p.j, g.j + lane);
      store(p.dx, g.dx + lane);
      store(p.dy, g.dy + lane);
      store(p.X, g.X + lane);
      store(p.Y, g.Y + lane);
    }
    for (int lane = 0; lane < g.count; ++lane)
      g.node[lane] = forces::lattice_sum::node_at(t, g.i[lane], g.j[lane]);
    for (int k = 0; k < 8; ++k)
      for (int lane = 0; lane < g.count; ++lane) g.fx[k][lane] = g.fy[k][lane] = 0.0;
    for (int from = 0; from < t.near; from += 8) add_near(forces, t, from, g);
    if (t.degree >= 0)
      for (int lane = 0; lane < g.count; ++lane) {
        const forces::lattice_sum::Slopes s = forces::lattice_sum::polynomial<width>(
            g.node[lane] + 2 * t.padded_near, t.degree, g.X[lane], g.Y[lane]);
        g.by_X[lane] = s.X;
        g.by_Y[lane] = s.Y;
      }
    for (int lane = 0; lane < g.count; lane += width) {
      Real fx = field.steepness * total(g.fx, lane), fy = field.steepness * total(g.fy, lane);
      if (t.degree >= 0)
        forces::lattice_sum::add_slopes(t, load(g.by_X + lane), load(g.by_Y + lane), fx, fy);
      double *ax = pack.ax + first + lane, *ay = pack.ay + first + lane;
      store(load(ax) + field.height * fx, ax);
      store(load(ay) + field.height * fy, ay);
    }
  }
}

void evaluate(const SoftForces& forces, SoftPack& pack) {
  for (int lane = 0; lane < pack.count; ++lane) pack.ax[lane] = pack.ay[lane] = 0.0;
  for (int k = 0; k < forces.potentials; ++k) {
    if (forces.lattice[k])
      add_lattice(forces, *forces.lattice[k], pack);
    else
      forces.other(forces, k, pack);
  }
  if (!forces.unit_mass)
    for (int lane = 0; lane < pack.count; lane += width) {
      store(forces.inverse_mass * load(pack.ax + lane), pack.ax + lane);
      store(forces.inverse_mass * load(pack.ay + lane), pack.ay + lane);
    }
  pack.fresh = true;
}

/// Does no wall, and no absurd number, come into the steps of these lanes? As Group::predict asks.
CAROM_INLINE Mask is_clear(const SoftForces& forces, const Real& third, const SoftPack& pack,
                           int lane) {
  const Vector x{load(pack.x + lane), load(pack.y + lane)},
      v{load(pack.vx + lane), load(pack.vy + lane)};
  Mask clear = (abs(x.x) + abs(x.y)) + (abs(v.x) + abs(v.y)) <= 1e100;
  if (forces.walls == 0) return clear;
  const Vector from{load(pack.from_x + lane), load(pack.from_y + lane)};
  clear =
      clear && abs(x.x - from.x) <= forces.longest_way && abs(x.y - from.y) <= forces.longest_way;
  const events::StepHull<Real> hull(from, {load(pack.from_vx + lane), load(pack.from_vy + lane)}, x,
                                    v, third);
  for (int i = 0; i < forces.walls; ++i) clear = clear && stays_off(forces.barriers[i], hull);
  return clear;
}

/// A lane has left the cell if a neighbouring cell's middle is nearer than that of its own.
CAROM_INLINE Mask has_left(const SoftForces& forces, const SoftPack& pack, int lane) {
  const Vector x{load(pack.x + lane), load(pack.y + lane)};
  const auto square = [&](const Vector& a) {
    const Vector d = a - Vector{Real(forces.centre_x), Real(forces.centre_y)};
    return dot(d, d);
  };
  const Real own = square(x);
  Mask left(false);
  for (int e = 0; e < forces.edges; ++e)
    left = left || square(x - Vector{Real(forces.across_x[e]), Real(forces.across_y[e])}) < own;
  return left;
}

void find_calls(const SoftForces& forces, double third, SoftPack& pack) {
  pack.calls = 0;
  for (int lane = 0; lane < pack.count; lane += width) {
    const Mask undecided = !is_clear(forces, Real(third), pack, lane);
    const Mask calls = undecided || has_left(forces, pack, lane);
    for (int k = 0; k < width; ++k) pack.undecided[lane + k] = (bits_of(undecided) >> k & 1U) != 0;
    if (!any_of(calls)) continue;
    for (int k = 0; k < width; ++k)
      if ((bits_of(calls) >> k & 1U) != 0) pack.lane[pack.calls++] = lane + k;
  }
}

void step(const SoftForces& forces, const SoftStage* stage, int stages, SoftPack& pack) {
  using Kind = SoftStage::Kind;
  for (int lane = 0; lane < pack.count; lane += width) {
    store(load(pack.x + lane), pack.from_x + lane);
    store(load(pack.y + lane), pack.from_y + lane);
    store(load(pack.vx + lane), pack.from_vx + lane);
    store(load(pack.vy + lane), pack.from_vy + lane);
    const Vector v{load(pack.vx + lane), load(pack.vy + lane)};
    store(max(load(pack.fastest + lane), dot(v, v)), pack.fastest + lane);
  }
  for (; stages > 0; --stages, ++stage) {
    if (stage->kind == Kind::kick && !pack.fresh) evaluate(forces, pack);
    for (int lane = 0; lane < pack.count; lane += width) {
      Vector x{load(pack.x + lane), load(pack.y + lane)},
          v{load(pack.vx + lane), load(pack.vy + lane)};
      const Real duration(stage->duration);
      switch (stage->kind) {
        case Kind::kick:
          v = v + duration * Vector{load(pack.ax + lane), load(pack.ay + lane)};
          break;
        case Kind::drift:
          stage->drift.move(x, v);
          break;
        case Kind::straight:
          x = x + duration * v;
          break;
        case Kind::turn:
          stage->drift.turn(v);
          break;
      }
      store(x.x, pack.x + lane);
      store(x.y, pack.y + lane);
      store(v.x, pack.vx + lane);
      store(v.y, pack.vy + lane);
    }
    if (stage->kind == Kind::drift || stage->kind == Kind::straight) pack.fresh = false;
  }
}

}  // namespace

template <>
SoftKernel soft_kernel<InstructionSet::CAROM_INSTRUCTION_SET>() {
  return {evaluate, step, find_calls, width};
}

}  // namespace carom::lanes
