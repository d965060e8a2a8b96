// Eight partners of a particle at a time. Each of the eight lanes has a sum of its own, whatever
// the machine's vectors are, and only + - * / and sqrt are used, which round alike everywhere:
// wider vectors change nothing but the time. Products and sums are not fused.
#include "forces/coulomb_pairs.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "base/interrupt.hpp"

namespace carom::forces {
namespace {

constexpr std::size_t lanes = 8;

// One entry a particle; pull_x and pull_y are those of one particle's partners.
struct Arrays {
  std::size_t size;
  const double *x, *y, *charge;
  double *force_x, *force_y, *pull_x, *pull_y;
  base::Interrupt* interrupt;
};

using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;

[[gnu::always_inline]] inline double sum_of(const double* a, std::size_t size) {
  Lanes sum = {};
  std::size_t j = 0;
  for (; j + lanes <= size; j += lanes) {
    Lanes eight;
    std::memcpy(&eight, a + j, sizeof eight);
    sum += eight;
  }
  for (std::size_t lane = 0; j < size; ++j, ++lane) sum[lane] += a[j];
  return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}

// The passes of the loop that follows are independent of each other. (Clang finds out by itself.)
#if defined(__clang__)
#define CAROM_INDEPENDENT
#else
#define CAROM_INDEPENDENT _Pragma("GCC ivdep")
#endif

struct One {
  double x, y, charge;  ///< the latter times the strength
};

[[gnu::always_inline]] inline void pull(One one, std::size_t partners, const double* __restrict x,
                                        const double* __restrict y, const double* __restrict charge,
                                        double* __restrict force_x, double* __restrict force_y,
                                        double* __restrict pull_x, double* __restrict pull_y) {
  CAROM_INDEPENDENT
  for (std::size_t j = 0; j < partners; ++j) {
    const double dx = one.x - x[j], dy = one.y - y[j];
    const double square = dx * dx + dy * dy;
    const double over_r = (one.charge * charge[j]) / (square * std::sqrt(square));
    const double fx = over_r * dx, fy = over_r * dy;
    pull_x[j] = fx;
    pull_y[j] = fy;
    force_x[j] -= fx;
    force_y[j] -= fy;
  }
}

[[gnu::always_inline]] inline void sum_pairs(double strength, const Arrays& a) {
  for (std::size_t i = 0; i < a.size; ++i) {
    const std::size_t next = i + 1, partners = a.size - next;
    if (a.interrupt && a.interrupt->after(static_cast<double>(partners))) return;
    pull({a.x[i], a.y[i], strength * a.charge[i]}, partners, a.x + next, a.y + next,
         a.charge + next, a.force_x + next, a.force_y + next, a.pull_x, a.pull_y);
    a.force_x[i] += sum_of(a.pull_x, partners);
    a.force_y[i] += sum_of(a.pull_y, partners);
  }
}

[[gnu::always_inline]] inline double sum_energies(double strength, const Arrays& a) {
  double all = 0.0;
  for (std::size_t i = 0; i < a.size; ++i) {
    const std::size_t next = i + 1, partners = a.size - next;
    if (a.interrupt && a.interrupt->after(static_cast<double>(partners))) return all;
    const One one{a.x[i], a.y[i], strength * a.charge[i]};
    const double *x = a.x + next, *y = a.y + next, *charge = a.charge + next;
    double* __restrict const energy = a.pull_x;
    CAROM_INDEPENDENT
    for (std::size_t j = 0; j < partners; ++j) {
      const double dx = one.x - x[j], dy = one.y - y[j];
      energy[j] = (one.charge * charge[j]) / std::sqrt(dx * dx + dy * dy);
    }
    all += sum_of(energy, partners);
  }
  return all;
}

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
[[gnu::target("avx2")]] void sum_pairs_avx2(double strength, const Arrays& a) {
  sum_pairs(strength, a);
}
[[gnu::target("avx2")]] double sum_energies_avx2(double strength, const Arrays& a) {
  return sum_energies(strength, a);
}
[[gnu::target("avx512f,prefer-vector-width=512")]] void sum_pairs_avx512(double strength,
                                                                         const Arrays& a) {
  sum_pairs(strength, a);
}
[[gnu::target("avx512f,prefer-vector-width=512")]] double sum_energies_avx512(double strength,
                                                                              const Arrays& a) {
  return sum_energies(strength, a);
}
#endif
void sum_pairs_baseline(double strength, const Arrays& a) { sum_pairs(strength, a); }
double sum_energies_baseline(double strength, const Arrays& a) { return sum_energies(strength, a); }

struct Sums {
  void (*pairs)(double, const Arrays&);
  double (*energies)(double, const Arrays&);
};
const Sums& widest() {
  static const Sums found = [] {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    if (__builtin_cpu_supports("avx512f")) return Sums{sum_pairs_avx512, sum_energies_avx512};
    if (__builtin_cpu_supports("avx2")) return Sums{sum_pairs_avx2, sum_energies_avx2};
#endif
    return Sums{sum_pairs_baseline, sum_energies_baseline};
  }();
  return found;
}

/// Places and charges in columns; those of forces are 0.
Arrays columns_of(std::span<const Particle> particles, std::span<const geometry::Vector> x,
                  base::Interrupt* interrupt) {
  thread_local std::vector<double> columns;
  const std::size_t n = x.size();
  columns.assign(7 * n, 0.0);
  double* const column = columns.data();
  for (std::size_t i = 0; i < n; ++i) {
    column[i] = x[i].x;
    column[n + i] = x[i].y;
    column[2 * n + i] = particles[i].charge;
  }
  return {n,
          column,
          column + n,
          column + 2 * n,
          column + 3 * n,
          column + 4 * n,
          column + 5 * n,
          column + 6 * n,
          interrupt};
}

}  // namespace

void add_coulomb_pairs(double strength, std::span<const Particle> particles,
                       std::span<const geometry::Vector> x, std::span<geometry::Vector> force,
                       base::Interrupt* interrupt) {
  const Arrays a = columns_of(particles, x, interrupt);
  widest().pairs(strength, a);
  for (std::size_t i = 0; i < a.size; ++i)
    force[i] = force[i] + geometry::Vector{a.force_x[i], a.force_y[i]};
}

double coulomb_energy(double strength, std::span<const Particle> particles,
                      std::span<const geometry::Vector> x, base::Interrupt* interrupt) {
  return widest().energies(strength, columns_of(particles, x, interrupt));
}

}  // namespace carom::forces
