// The sections of a system, read one by one. Each fills in its defaults.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/certify/exact_system.hpp"
#include "carom/forces/force_spec.hpp"
#include "carom/system/report_times.hpp"
#include "carom/system/system.hpp"
#include "carom/table/table.hpp"
#include "carom/table/table_spec.hpp"
#include "files/toml/toml_section.hpp"
#include "files/toml/value.hpp"

namespace carom::files {

/// In a trajectory, those that enter later included.
inline constexpr std::uint64_t most_particles = 1000000;

/// [table] with its holes and loops, and [lattice].
TableSpec read_table(Value& root);
/// [particles] and [field]; without speed or energy the speed is that of initial.velocity.
std::vector<Particle> read_particles(Value& root);
/// [initial]; names of walls and holes are those of the table.
InitialCondition read_initial(Value& root, const Table& table,
                              const std::vector<Particle>& particles);
/// [[injection]]: each particle that enters is like the first one, at its own speed.
std::vector<Injection> read_injections(Value& root, const Table& table,
                                       const std::vector<Particle>& particles, double t_max);
/// [run]. `starts`: how many trajectories start differently where starts are listed, which is the
/// default of trajectories; else 0.
RunPlan read_run(Value& root, std::uint64_t starts = 0);
/// run.times where they are not written.
Value default_times(const Value& t_max, const Place& place);
/// The energies of the particles where these are given; empty where speeds are.
std::vector<double> read_energies(Value& root, std::size_t particles);
/// [[potential]] and [interaction].
ForceSpec read_forces(Value& root, std::size_t particles);
/// [integrator]. Where `forces` act it is checked whether the plan can be carried out.
IntegratorPlan read_integrator(Value& root, bool forces, const std::vector<Particle>& particles,
                               bool walls);
/// [section]; the names of walls are those of the table.
SectionPlan read_section(Value& root, const Table& table);

/// Speed, field and start of the first particle, as they were written; after the other sections.
ExactSystem read_exact(Value& root, bool free);

/// "(1/3)": as a part of a longer expression.
inline std::string in_brackets(const ExactNumber& n) { return "(" + n.text() + ")"; }

using carom::spaced;

/// Replaces the shape svg by a path, whose loop is the outermost curve of the drawing, and by
/// obstacles, which are the others; what is resolved can be run again without the file. Any other
/// shape is left alone.
void take_drawing(Value& table);

/// Replaces the `path` of discs by centers (and radii, where the file has them), that of a polygon
/// or a spline by points, so that what is resolved can be run again without the file. Anything else
/// is left alone.
void take_points_from_file(Value& table, const std::string& section);

/// Turns kind = "file" into the list of the starts that the file holds, so that what is resolved
/// can be run again without it. Anything else is left alone.
void take_starts_from_file(Value& initial);

/// Sets the speeds to the lengths of the listed velocities if neither speed nor energy is given.
void take_speeds_from_starts(Value& root);

/// Index of the hole; an InputError at the place lists the names there are.
int hole_named(const Table& table, const std::string& name, const Place& place);

}  // namespace carom::files
