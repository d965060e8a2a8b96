// Reads back what a run that goes on needs of its archive.
#include "io/archive/stored_run.hpp"

#include <cmath>

#include "carom/base/error.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/geometry/curve.hpp"
#include "io/archive/archive_file.hpp"
#include "io/archive/checksums.hpp"
#include "io/archive/columns.hpp"
#include "io/archive/step_numbers.hpp"
#include "io/archive/trust_columns.hpp"
#include "io/checkpoint/ensemble_files.hpp"

namespace carom {

using namespace io;
using hdf5::Handle;

void io::check_stored(const StoredRun& run, const System& system, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(Place{file, 0, 0, ""}, "'/state' " + what, "an archive as carom wrote it");
  };
  const std::size_t particles =
      system.particles.size() +
      (system.injections.empty() ? 0 : injected_count(system, run.trajectory.value_or(0)));
  if (run.particles.size() != particles)
    refuse("has " + std::to_string(run.particles.size()) + " particles, the system has " +
           std::to_string(particles));
  const auto walls = static_cast<std::int64_t>(system.table->walls.size()),
             holes = static_cast<std::int64_t>(system.table->holes.size());
  const auto one_of = [](std::int64_t index, std::int64_t count) {
    return index >= -1 && index < count;
  };
  for (const ParticleProgress& p : run.particles) {
    const State& s = p.state;
    if (!one_of(s.wall, walls) || !one_of(p.last_wall, walls)) refuse("names a wall that is none");
    if (!one_of(p.hole, holes)) refuse("names a hole that is none");
    if (p.fate > last_fate) refuse("names a fate that is none");
    for (const double x : {s.position.x, s.position.y, s.velocity.x, s.velocity.y, s.u, p.speed,
                           s.time.value(), p.end.value()})
      if (!std::isfinite(x)) refuse("holds what is no number");
    if (p.end < s.time) refuse("has an end before its last event");
    if (s.wall >= 0 &&
        !(s.u >= 0.0 && s.u <= geometry::end_parameter(
                                   system.table->walls[static_cast<std::size_t>(s.wall)].curve)))
      refuse("is beyond the end of its wall");
  }
}

StoredRun read_run(const std::string& name) {
  const Place place{name, 0, 0, ""};
  const Handle file =
      open_archive(name, "the file is not an archive, or its run was killed or is still going on",
                   "the archive of a finished or interrupted run");
  if (hdf5::read_string_attribute(file.get(), "kind", name) != run_archive_kind)
    throw InputError(place, "the archive holds no run in double precision",
                     "an archive written by carom run");
  StoredRun run;
  run.status = hdf5::read_string_attribute(file.get(), "status", name);
  if (run.status == "running")
    throw InputError(place, "its run was killed", "the archive of a finished or interrupted run");
  hdf5::verify(file.get(), name);  // what goes on is kept beside what it goes on from
  run.system_toml = hdf5::read_text(file.get(), "system", name);
  const Handle provenance(H5Gopen2(file.get(), "provenance", H5P_DEFAULT), H5Gclose);
  run.system_name = hdf5::read_string_attribute(provenance.get(), "system", name);
  run.engine = hdf5::read_string_attribute(provenance.get(), "engine", name);
  const Seconds seconds = ArchiveFile::read_seconds(provenance.get(), name);
  run.seconds = seconds.wall;
  run.cpu_seconds = seconds.cpu;
  if (H5Aexists(provenance.get(), trajectory_key) > 0)
    run.trajectory = hdf5::read_count_attribute(provenance.get(), trajectory_key, name);

  const Handle state(H5Gopen2(file.get(), "state", H5P_DEFAULT), H5Gclose);
  const auto reals = [&](const char* field) {
    return hdf5::read_column<double>(state.get(), field, name);
  };
  const auto integers = [&](const char* field) {
    return hdf5::read_column<std::int64_t>(state.get(), field, name);
  };
  const auto wall = integers("wall"), first = integers("cell_first"),
             second = integers("cell_second"), hits = integers("hits"),
             contacts = integers("contacts"), last_wall = integers("last_wall"),
             hole = integers("hole"), fate = integers("fate");
  const auto u = reals("u"), x = reals("x"), y = reals("y"), vx = reals("vx"), vy = reals("vy"),
             high = reals("t_high"), low = reals("t_low"), end_high = reals("end_high"),
             end_low = reals("end_low");
  const auto later = [&](const char* field, double none = 0.0) {  // none in earlier builds
    const bool there = hdf5::has(state.get(), field);
    return there ? reals(field) : std::vector<double>(wall.size(), none);
  };
  const auto change = later("energy_change"), largest = later("energy_largest"),
             kinetic = later("energy_kinetic"), speed = later("speed"),
             change_low = later("energy_change_low"),
             last = later("energy_last", EnergyBalance().last);
  for (std::size_t i = 0; i < wall.size(); ++i) {
    ParticleProgress p;
    p.state.wall = static_cast<int>(wall[i]);
    p.state.u = u.at(i);
    p.state.position = {x.at(i), y.at(i)};
    p.state.velocity = {vx.at(i), vy.at(i)};
    p.speed = speed.at(i);
    p.state.cell = {first.at(i), second.at(i)};
    p.state.time = {high.at(i), low.at(i)};
    p.end = {end_high.at(i), end_low.at(i)};
    p.hits = static_cast<std::uint64_t>(hits.at(i));
    p.contacts = static_cast<std::uint64_t>(contacts.at(i));
    p.last_wall = static_cast<std::int32_t>(last_wall.at(i));
    p.hole = static_cast<std::int32_t>(hole.at(i));
    p.fate = static_cast<Fate>(fate.at(i));
    p.energy = {change.at(i), largest.at(i), kinetic.at(i), change_low.at(i), last.at(i)};
    run.particles.push_back(p);
  }
  if (hdf5::has(file.get(), "steps")) {
    const Handle steps(H5Gopen2(file.get(), "steps", H5P_DEFAULT), H5Gclose);
    for (const StepNumber& number : step_numbers)
      if (!number.later || hdf5::has(steps.get(), number.name))
        run.steps.*number.value =
            hdf5::read_column<std::uint64_t>(steps.get(), number.name, name).at(0);
    if (hdf5::has(steps.get(), shortest_part))
      run.steps.shortest_part = hdf5::read_column<double>(steps.get(), shortest_part, name).at(0);
    run.evaluations.count = run.steps.force_evaluations;
    if (hdf5::has(steps.get(), going_on)) {
      run.evaluations.count = hdf5::read_column<std::uint64_t>(steps.get(), going_on, name).at(0);
      run.evaluations.predicted =
          hdf5::read_column<std::uint64_t>(steps.get(), predicted, name).at(0) != 0;
    }
    run.steps.first_unresolved =
        hdf5::read_column<double>(steps.get(), first_unresolved, name).at(0);
  }
  if (hdf5::has(file.get(), "trust"))
    read_trust(Handle(H5Gopen2(file.get(), "trust", H5P_DEFAULT), H5Gclose).get(), run.particles,
               name);
  return run;
}

}  // namespace carom
