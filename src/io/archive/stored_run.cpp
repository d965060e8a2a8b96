// Reads back what a run that goes on needs of its archive.
#include "carom/base/error.hpp"
#include "io/archive/archive_file.hpp"
#include "io/archive/checksums.hpp"
#include "io/archive/columns.hpp"
#include "io/archive/step_numbers.hpp"
#include "io/archive/trust_columns.hpp"
#include "io/checkpoint/ensemble_files.hpp"

namespace carom {

using namespace io;
using hdf5::Handle;

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
  const auto later = [&](const char* field) {  // 0 in archives of earlier builds
    const bool there = hdf5::has(state.get(), field);
    return there ? reals(field) : std::vector<double>(wall.size(), 0.0);
  };
  const auto change = later("energy_change"), largest = later("energy_largest"),
             kinetic = later("energy_kinetic"), speed = later("speed");
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
    p.energy = {change.at(i), largest.at(i), kinetic.at(i)};
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
    run.steps.first_unresolved =
        hdf5::read_column<double>(steps.get(), first_unresolved, name).at(0);
  }
  if (hdf5::has(file.get(), "trust"))
    read_trust(Handle(H5Gopen2(file.get(), "trust", H5P_DEFAULT), H5Gclose).get(), run.particles,
               name);
  return run;
}

}  // namespace carom
