// Sums over many equal bumps: Fermi discs and Gaussians at given centres, or on a lattice.
#pragma once

#include "forces/bump_series.hpp"
#include "forces/potential.hpp"

namespace carom::forces {

/// Adds the second derivatives of one bump of this height at d from its centre.
void add_bump_hessian(const BumpShape&, double height, geometry::Vector d, Hessian&);

/// Distances beyond which all copies of a bump together add less than tail_share of its height
/// (docs/physics/forces.md derives them).
double fermi_sum_reach(double radius, double softness, const geometry::Lattice&);
double gaussian_sum_reach(double width, const geometry::Lattice&);

std::unique_ptr<const Potential> make_fermi_bumps(double height, double radius, double softness,
                                                  const std::vector<geometry::Vector>& centers);
std::unique_ptr<const Potential> make_gaussian_bumps(double height, double width,
                                                     const std::vector<geometry::Vector>& centers);

}  // namespace carom::forces
