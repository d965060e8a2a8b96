#include "carom/files/system_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carom/engines/choose_step.hpp"
#include "carom/events/decision_range.hpp"
#include "carom/events/medium.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "files/text_file.hpp"
#include "files/toml/overrides.hpp"
#include "files/toml/read.hpp"
#include "table/bezier_wall.hpp"

namespace carom {
namespace {

using files::Value;

const std::vector<std::string> known_sections{"table",       "lattice",   "field",   "potential",
                                              "interaction", "particles", "initial", "injection",
                                              "integrator",  "run",       "section"};
/// Sections that stay away unless they are written.
const std::vector<std::string> optional_sections{
    "table", "lattice", "potential", "interaction", "injection", "integrator", "section"};

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// ", it belongs to [SECTION], …": a key above all sections.
std::string owners_of(const std::string& key) {
  std::vector<std::string> owners;
  for (const KeyDescription& one : key_table()) {
    const std::string section = "[" + std::string(one.section) + "]";
    if (one.key == key && contains(known_sections, std::string(one.section)) &&
        !contains(owners, section))
      owners.push_back(section);
  }
  return owners.empty() ? "" : ", it belongs to " + files::listed(owners);
}

void check_sections(const Value& root) {
  for (const files::Entry& entry : root.entries) {
    if (entry.key == "title" || contains(known_sections, entry.key)) continue;
    std::vector<std::string> names = known_sections;
    names.emplace_back("title");
    throw InputError(entry.place,
                     "unknown section or key '" + entry.key + "'" + owners_of(entry.key),
                     "one of " + files::listed(names), nearest_name(entry.key, names));
  }
}

// Sections that may be left out are empty, in the order in which they are printed. Nothing is
// added to the root afterwards, so that references into it stay valid.
void complete_sections(Value& root) {
  Value ordered;
  ordered.place = root.place;
  Value title = files::text_value("", {root.place.file, 0, 0, "title"});
  ordered.set("title", root.find("title") != nullptr ? *root.find("title") : title);
  for (const std::string& name : known_sections) {
    Value* written = root.find(name);
    if (written == nullptr && contains(optional_sections, name)) continue;
    Value empty;
    empty.place = {root.place.file, 0, 0, name};
    ordered.set(name, std::move(written != nullptr ? *written : empty));  // millions of values
  }
  root = std::move(ordered);
}

// Steps end at the multiples of the step, which are counted in doubles. A run until its cap on hits
// may ask for any last time: it ends there if it comes so far.
void check_number_of_steps(const Value& root, const System& system) {
  constexpr double most = 0x1p52;
  const double step = system.dynamics.integrator.step, t_max = system.run.t_max;
  if (!(step > 0.0) || t_max >= no_last_time || t_max / step < most) return;
  throw InputError(root.find("run")->find("t_max")->place,
                   "t_max = " + files::shown(t_max) + " is " + files::shown(t_max / step) +
                       " steps of " + files::shown(step) + ": steps are counted up to 2^52",
                   "t_max below " + files::shown(step * most) + ", or a longer step");
}

void check_scales(const Value& root, const System& system, const Table& table) {
  const std::string fault = beyond_decisions(table, system.particles);
  if (fault.empty()) return;
  throw InputError(root.find("particles")->place, fault,
                   "other units, in which lengths, speeds and frequencies are nearer to 1");
}

// Where no particle can be, an obstacle does.
void check_regions(const Value& root, const System& system, const Table& table) {
  for (std::size_t r = 0; r < table.regions.size(); ++r) {
    const Place& place = root.find("table")->find("region")->items[r].place;
    if (system.has_forces() || system.of_discs())
      throw InputError(place, "forces and hard discs know no regions",
                       "free particles, or no [[table.region]]");
    for (const Particle& p : system.particles) {
      if (!(p.speed > 0.0) || in_region(table, p, static_cast<int>(r)).speed > 0.0) continue;
      throw InputError(place,
                       "the potential " + files::shown(table.regions[r].potential) +
                           " is not below the kinetic energy " +
                           files::shown(0.5 * p.mass * p.speed * p.speed),
                       "a lower potential");
    }
  }
}

// A disc's centre would keep its distance from a curve, along no Bézier curve.
void check_beziers(const Value& root, const System& system, const Table& table) {
  const Wall* wall = table::bezier_wall(table);
  if (wall == nullptr || !system.of_discs()) return;
  throw InputError(root.find("interaction")->place,
                   "hard discs beside Bézier curves, of which wall '" + wall->name + "' is one",
                   "walls of segments, circles and ellipses, or another interaction");
}

// Samples are counted as steps are.
void check_number_of_samples(const Value& root, const System& system) {
  constexpr double most = 0x1p52;
  const double t_max = system.run.t_max;
  if (!(system.run.sample > 0.0) || t_max >= no_last_time || t_max / system.run.sample < most)
    return;
  throw InputError(root.find("run")->find("sample")->place,
                   files::shown(t_max / system.run.sample) + " samples until t_max = " +
                       files::shown(t_max) + ": they are counted up to 2^52",
                   "a time above " + files::shown(t_max / most) + " between samples");
}

// Where a particle that meets no wall is on its circle at the time t, an angle omega t tells: it
// needs all its digits before the point.
void check_angles(const Value& root, const System& system) {
  constexpr double most = 0x1p52;
  const double t_max = system.run.t_max;
  double omega = 0.0;
  for (const Particle& p : system.particles) omega = std::max(omega, std::fabs(p.omega));
  if (t_max >= no_last_time || omega * t_max < most) return;
  throw InputError(root.find("run")->find("t_max")->place,
                   "until t_max = " + files::shown(t_max) + " a particle turns by " +
                       files::shown(omega * t_max) + " in the field: angles are known up to 2^52",
                   "t_max below " + files::shown(most / omega) + ", or a weaker field");
}

// Each step takes the forces of all pairs several times, and keeps the positions at several times
// within it.
void check_number_of_pairs(const Value& root, const System& system) {
  constexpr std::size_t most = std::size_t{1} << 13;
  if (!system.dynamics.forces->interacts() || system.particles.size() <= most) return;
  const Value* count = root.find("particles")->find("count");
  throw InputError(count ? count->place : Place{root.place.file, 0, 0, "particles.count"},
                   std::to_string(system.particles.size()) +
                       " particles that interact are too many pairs for each step",
                   "at most " + std::to_string(most));
}

void check_rest(const Value& root, const System& system) {
  const bool rests = std::any_of(system.particles.begin(), system.particles.end(),
                                 [](const Particle& p) { return p.speed == 0.0; });
  if (!rests || system.of_discs() || system.has_forces()) return;
  const Value* speed = root.find("particles")->find("speed");
  throw InputError(speed ? speed->place : system.initial.place,
                   "the particle rests, and no force acts on it", "a velocity that is not zero");
}

// The title says what the command line changed in the system. Where its particles start, how long
// it runs and where sections are taken is no part of it.
void note_changes(const SystemOverrides& overrides, Value& root) {
  std::string& title = root.find("title")->text;
  if (title.empty()) return;
  std::string changes;
  for (std::size_t i = 0; i < overrides.set.size(); ++i) {
    const auto& [path, text] = overrides.set[i];
    if (path == "title") return;
    const bool again =
        std::any_of(overrides.set.begin() + static_cast<std::ptrdiff_t>(i) + 1, overrides.set.end(),
                    [&key = path](const auto& later) { return later.first == key; });
    const std::string section = path.substr(0, path.find('.'));
    if (again || section == "run" || section == "section" || section == "initial") continue;
    const std::string change = path == "table.hole" && text == "[]"  ? "no holes"
                               : text.find('{') != std::string::npos ? path + " changed"
                                                                     : path + " = " + text;
    if (title.find(change) != std::string::npos) continue;  // a stored system has it already
    changes += (changes.empty() ? ", with " : ", ") + change;
  }
  title += changes;
}

std::string text_of_builtin(const std::string& name) {
  std::vector<std::string> names;
  for (const BuiltinSystem& system : builtin_systems()) {
    if (system.name == name) return std::string(system.toml);
    names.emplace_back(system.name);
  }
  throw InputError(Place{}, "unknown system '" + name + "'",
                   "a file (with '/' or ending in .toml), or one of " + files::listed(names),
                   nearest_name(name, names));
}

}  // namespace

LoadedSystem read_system(std::string_view toml, const std::string& file,
                         const SystemOverrides& overrides) {
  Value root = files::parse_document(toml, file);
  root.place = {file, 0, 0, ""};
  files::apply(overrides, root);
  check_sections(root);
  complete_sections(root);
  files::as_text(*root.find("title"));
  note_changes(overrides, root);
  LoadedSystem loaded;
  System& system = loaded.system;
  system.name = file;
  system.title = files::as_text(*root.find("title"));
  auto spec = std::make_shared<const TableSpec>(files::read_table(root));
  auto table = std::make_shared<Table>(build_table(*spec));
  system.particles = files::read_particles(root);
  const ForceSpec forces = files::read_forces(root, system.particles.size());
  system.dynamics.forces = ForceField::build(forces, system.particles, table->lattice);
  check_beziers(root, system, *table);
  check_regions(root, system, *table);
  check_scales(root, system, *table);
  const std::vector<double>& radii = system.dynamics.forces->disc_radii();
  for (std::size_t p = 0; p < radii.size(); ++p) system.particles[p].radius = radii[p];
  system.dynamics.integrator =
      files::read_integrator(root, system.has_forces(), system.particles, !table->walls.empty());
  if (system.has_forces()) system.energies = files::read_energies(root, system.particles.size());
  system.initial = files::read_initial(root, *table, system.particles);
  // Where particles enter at random no trajectory repeats another.
  system.run =
      files::read_run(root, root.find("injection") != nullptr ? 0 : listed_trajectories(system));
  check_number_of_pairs(root, system);
  check_rest(root, system);
  check_number_of_samples(root, system);
  check_angles(root, system);
  system.injections = files::read_injections(root, *table, system.particles, system.run.t_max);
  if (system.has_forces()) refuse_injections(system, "a system with forces");
  if (!radii.empty()) refuse_injections(system, "a system of hard discs");
  system.section = files::read_section(root, *table);
  system.table = std::move(table);
  if (overrides.choose_step && needs_step(system)) {
    const double step = choose_step(system).step;
    system.dynamics.integrator.step = step;
    system.dynamics.integrator.step_chosen = true;
    files::TomlSection section(*root.find("integrator"), "integrator");
    section.fill("step", files::number_value(fmt::format("{}", step), section.place_of("step")));
    section.fill("step_chosen", files::flag_value(true, section.place_of("step_chosen")));
  }
  check_number_of_steps(root, system);
  loaded.exact = files::read_exact(root, system.dynamics.forces->empty() && !system.of_discs());
  loaded.exact.spec = std::move(spec);
  loaded.exact.table = system.table;
  loaded.t_max = files::as_number(*root.find("run")->find("t_max"));
  loaded.resolved_toml = files::print_document(root);
  return loaded;
}

LoadedSystem load_system(const std::string& name, const SystemOverrides& overrides) {
  if (name.ends_with(".h5") || name.ends_with(".hdf5"))
    throw InputError({name, 0, 0, ""}, "an archive is not a system",
                     "a system; carom plot draws an archive, --resume continues it");
  const bool is_file = name.find('/') != std::string::npos || name.ends_with(".toml");
  if (!is_file) return read_system(text_of_builtin(name), name, overrides);
  const std::string text =
      files::text_of_file(name, files::most_of_system_file, {name, 0, 0, ""}, "", "a TOML file");
  return read_system(text, name, overrides);
}

}  // namespace carom
