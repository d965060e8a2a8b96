// How long a step may be where forces act, known before it is taken: docs/physics/resolution.md.
//
// Where the force is bounded by F over all complex displacements of size rho from a place, the
// motion that starts there with speed v is analytic for complex times |t| <= T, if v T + F T^2/(2
// m) <= rho (times exp(omega T) in a field). What a scheme's few stages see of such a motion is all
// there is to it; a narrower force would make T shorter.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "carom/forces/force_field.hpp"
#include "forces/force_bound.hpp"

namespace carom::forces {

namespace resolution {

/// A step is resolved if the motion is analytic for complex times up to half of it about both of
/// its ends.
inline constexpr double steps_a_radius = 2.0;
/// Where pieces of a force meet, a step may change the velocity by this share of itself through the
/// difference.
inline constexpr double kick_share = 0.25;

/// Complex times up to `time`, and what a magnetic field multiplies displacements with by then.
struct Span {
  double time = 0.0, growth = 1.0;
  double over_time = 0.0;  ///< 1/(growth time)
};
Span span_of(double time, double omega);

/// Does a motion stay within rho?
inline bool stays(double speed, double acceleration, const Span& span, double rho) {
  return span.growth * span.time * (speed + 0.5 * acceleration * span.time) <= rho;
}

}  // namespace resolution

/// Bounds of the external force on one kind of particle, over the meshes of grids and displacements
/// of two meshes: computed where they are asked for, and kept for a while. The answers depend on
/// the arguments alone.
class ForceMap {
 public:
  /// Refers to `forces`.
  ForceMap(const ForceField& forces, const Particle& kind);
  const Particle& kind() const { return kind_; }

  /// Is the motion from x analytic over the span? `square_way`: of about how far it leads, a hint.
  bool resolves(geometry::Vector x, double square_speed, double square_way,
                const resolution::Span& span) {
    const int coarsest = exponent_for(square_speed, square_way, span);
    if (coarsest != no_exponent && stays(x, square_speed, coarsest - first_finer_, span)) [[likely]]
      return true;
    return resolves_closely(x, square_speed, coarsest, span);
  }
  /// resolves() for many motions at once, by the bounds that are kept now: true is its answer,
  /// false is none. Loops without branches take half the time.
  static constexpr int most_at_once = 64;
  struct Motions {
    int count = 0;
    const double *x = nullptr, *y = nullptr;
    double square_speed[most_at_once], square_way[most_at_once];
  };
  void resolve_known(const Motions&, const resolution::Span&, bool* known) const;

 private:
  void resolve_known(const Motions&, int finer, const int* which, int count,
                     const resolution::Span&, bool* known) const;

 public:
  /// Bounds of the acceleration within displacements of rho or a little more, a power of two.
  ForceBound about(geometry::Vector x, double rho);
  /// Is every motion of that total energy which starts in the box, where `inside` holds, analytic
  /// over the span? Energies are looked at in nine points of each mesh: for choosing a step, which
  /// is checked again when it is taken. Meshes are taken from `left`; a force that needs more of
  /// them is too narrow.
  bool resolves_everywhere(geometry::Vector low, geometry::Vector high, double energy,
                           const std::function<bool(geometry::Vector)>& inside,
                           const resolution::Span&, int& left);

 private:
  static constexpr int no_exponent = std::numeric_limits<int>::min();
  /// The bound of an acceleration over the mesh that the key names.
  struct Entry {
    std::uint64_t key = 0;  ///< 0: none
    float force = 0.0f, jump = 0.0f;
  };

  static double power_of_two(int e) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52);
  }
  /// The coarsest meshes to try, 2^exponent: 4 to 32 times as large as the way.
  static int exponent_for(double square_speed, double square_way, const resolution::Span& span) {
    const double by_speed = square_speed * (span.time * span.time);
    const double square =
        span.growth * span.growth * (square_way > by_speed ? square_way : by_speed);
    return square > 0x1p-1000 && square < 0x1p1000 ? exponent_of(square) : no_exponent;
  }
  static int exponent_of(double square) {
    const int e = (static_cast<int>(std::bit_cast<std::uint64_t>(square) >> 52) - 1021) / 2 + 2;
    constexpr int coarseness = 3, far_below = 1200;  // a multiple of three
    return (e + far_below + coarseness - 1) / coarseness * coarseness - far_below;
  }
  bool stays(geometry::Vector x, double square_speed, int exponent, const resolution::Span& span) {
    const double over = power_of_two(-exponent);
    const Entry& e = entry(exponent, x.x * over, x.y * over);
    const double most = power_of_two(exponent + 1) * span.over_time -
                        0.5 * static_cast<double>(e.force) * span.time;
    if (!(most >= 0.0 && square_speed <= most * most)) return false;
    if (e.jump == 0.0f) [[likely]]
      return true;
    const double kick = static_cast<double>(e.jump) * resolution::steps_a_radius * span.time /
                        resolution::kick_share;
    return square_speed >= kick * kick;
  }
  /// The entry of the mesh whose corner is i and j rounded down; a whole number may be of either
  /// mesh.
  const Entry& entry(int exponent, double i, double j) {
    if (!has_key(i, j)) return compute(beyond_, 0, exponent, std::floor(i), std::floor(j));
    const Place place = place_of(exponent, i, j);
    Entry& kept = entries_[place.slot];
    return kept.key == place.key
               ? kept
               : compute(kept, place.key, exponent, place.i - whole, place.j - whole);
  }
  /// The place where an entry is kept. i, j: whole numbers, in the lowest bits.
  struct Place {
    double i, j;
    std::uint64_t key;
    std::size_t slot;
  };
  static constexpr double most_meshes = 0x1p25,
                          whole = 0x1.8p52;  // adding it leaves a whole number in the lowest bits
  static bool has_key(double i, double j) {
    return (i < most_meshes) & (i > -most_meshes) & (j < most_meshes) & (j > -most_meshes);
  }
  static Place place_of(int exponent, double i, double j) {
    const double rounded_i = (i - 0.5) + whole, rounded_j = (j - 0.5) + whole;
    const std::uint64_t a = std::bit_cast<std::uint64_t>(rounded_i),
                        b = std::bit_cast<std::uint64_t>(rounded_j);
    const std::uint64_t of_exponent = static_cast<std::uint64_t>(exponent + 2048);
    // Neighbours lie side by side in squares of 128 times 128.
    return {rounded_i, rounded_j, of_exponent << 52 | (a & 0x3ffffff) << 26 | (b & 0x3ffffff),
            static_cast<std::size_t>(((a & 127) + 128 * (b & 127) + 16384 * of_exponent) &
                                     (kept_entries - 1))};
  }
  const Entry& compute(Entry&, std::uint64_t key, int exponent, double i, double j) const;
  bool resolves_mesh(int exponent, double i, double j, double energy,
                     const std::function<bool(geometry::Vector)>& inside, const resolution::Span&,
                     int& left);
  bool resolves_closely(geometry::Vector x, double square_speed, int coarsest,
                        const resolution::Span&);

  static constexpr std::size_t kept_entries = 65536;
  const ForceField& forces_;
  Particle kind_;
  /// The meshes that mostly answer are asked first: those of half the coarsest size, or, if bounds
  /// take long, the coarsest, of which there are fewer. The order changes no answer.
  const int first_finer_;
  std::vector<Entry> entries_;
  Entry beyond_;  ///< of a mesh whose key does not fit
};

/// One map a kind of particle.
class ForceMaps {
 public:
  explicit ForceMaps(const ForceField& forces) : forces_(forces) {}
  ForceMap& of(const Particle& kind);

 private:
  const ForceField& forces_;
  std::vector<std::unique_ptr<ForceMap>> maps_;
};

}  // namespace carom::forces
