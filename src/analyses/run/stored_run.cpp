// Reads back what a run that goes on needs of its archive.
#include "analyses/run/stored_run.hpp"

#include <cmath>

#include "analyses/run/trust_columns.hpp"
#include "carom/base/error.hpp"
#include "carom/geometry/curve.hpp"
#include "carom/starts/injection.hpp"
#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/checksums.hpp"
#include "files/hdf5/fields.hpp"

namespace carom {

using namespace files;
using namespace analyses;
using hdf5::Handle;

void analyses::check_stored(const StoredRun& run, const System& system, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(Place{file, 0, 0, ""}, "'/state' " + what, "an archive as carom wrote it");
  };
  const std::size_t particles =
      system.particles.size() +
      (system.injections.empty() ? 0 : injected_count(system, run.trajectory));
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
  read_head(file.get(), name, run, run);
  run.trajectory = hdf5::read_attribute<std::uint64_t>(
      open_group(file.get(), "provenance", name).get(), trajectory_key, name);

  const Handle state(H5Gopen2(file.get(), "state", H5P_DEFAULT), H5Gclose);
  run.particles = read_all_rows<ParticleProgress>(state.get(), name);
  if (hdf5::has(file.get(), "steps")) {
    const Handle steps(H5Gopen2(file.get(), "steps", H5P_DEFAULT), H5Gclose);
    read_numbers(steps.get(), run.steps, name);
    run.evaluations.count = run.steps.force_evaluations;
    read_numbers(steps.get(), run.evaluations, name);
  }
  if (hdf5::has(file.get(), "trust"))
    read_trust(Handle(H5Gopen2(file.get(), "trust", H5P_DEFAULT), H5Gclose).get(), run.particles,
               name);
  return run;
}

}  // namespace carom
