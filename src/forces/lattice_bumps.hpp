// Bumps repeated on a lattice: the table that sums their copies, and the potential made of it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "carom/geometry/lattice.hpp"
#include "forces/bump_series.hpp"
#include "forces/lattice_sum.hpp"
#include "forces/potential.hpp"

namespace carom::forces {

/// The sum of all copies nearer than `reach`, which leaves out less than tail_share, by a table
/// whose own error is below tail_share, too (times height; for the force: times height/length()).
class LatticeTable {
 public:
  LatticeTable(const BumpShape&, const std::vector<geometry::Vector>& centers,
               const geometry::Lattice&, double reach);
  const LatticeSum& sum() const { return sum_; }
  /// The bound of the polynomials' error, and the copies that polynomials and near lists sum at a
  /// node at most.
  double error() const { return error_; }
  std::size_t copies() const { return copies_; }

 private:
  struct alignas(64) Line {
    double numbers[8];
  };
  LatticeSum sum_;
  double error_ = 0.0;
  std::size_t copies_ = 0;
  std::vector<Line> lines_;
};

/// The point as seen from each copy, on the lattice, of the centres that is nearer than `reach`;
/// nothing where these are more than `most`.
std::optional<std::vector<geometry::Vector>> seen_from_copies(
    geometry::Vector point, const std::vector<geometry::Vector>& centers, const geometry::Lattice&,
    double reach, double most);

std::unique_ptr<const Potential> make_lattice_bumps(const BumpShape&, double height,
                                                    const std::vector<geometry::Vector>& centers,
                                                    const geometry::Lattice&, double reach);

}  // namespace carom::forces
