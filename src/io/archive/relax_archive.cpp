#include "carom/io/relax_archive.hpp"

#include <span>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "io/archive/archive_file.hpp"
#include "io/archive/checksums.hpp"
#include "io/checkpoint/ensemble_files.hpp"

namespace carom {

using namespace io;
using hdf5::Description;
using hdf5::Handle;

namespace {

constexpr const char* relax_archive_kind = "relax";

/// A column of numbers, one a row of `rows`.
template <class T, class Rows, class Of>
void write(hid_t group, const char* name, const Rows& rows, Of of, Description description,
           const std::string& file) {
  std::vector<T> values;
  for (const auto& row : rows) values.push_back(static_cast<T>(of(row)));
  hdf5::write_column(group, name, std::span<const T>(values), description, file);
}

struct ParticleRow {
  std::uint64_t equilibrium;
  double x, y;
  int wall;
};
struct ModeRow {
  std::uint64_t equilibrium;
  NormalMode mode;
};

Handle open_group(hid_t file, const char* name) {
  return Handle(H5Gopen2(file, name, H5P_DEFAULT), H5Gclose);
}

}  // namespace

void write_equilibria(const std::string& target, const LoadedSystem& loaded,
                      const Provenance& origin, const RelaxResult& result, bool force,
                      ArchiveLock lock) {
  if (!lock) lock = lock_archive(target);
  refuse_existing(target, force);
  ArchiveFile file = ArchiveFile::create(aside_of(target), target);
  file.write_head(relax_archive_kind, loaded, origin);
  {
    const Handle group = file.group("equilibria", "Where all forces vanish, by rising energy");
    const hid_t to = group.get();
    const auto& all = result.equilibria;
    using E = Equilibrium;
    hdf5::write_number(to, "starts", result.starts, {"1", "Starts that were followed"}, target);
    hdf5::write_number(to, "without", result.without, {"1", "Searches that came to no equilibrium"},
                       target);
    write<double>(
        to, "energy", all, [](const E& e) { return e.energy; },
        {"energy", "Potential energy of all particles"}, target);
    write<double>(
        to, "energy_error", all, [](const E& e) { return e.energy_error; },
        {"energy", "Bound of its rounding"}, target);
    write<double>(
        to, "position_error", all, [](const E& e) { return e.position_error; },
        {"length", "Error of a coordinate"}, target);
    write<std::int64_t>(
        to, "descending", all, [](const E& e) { return e.descending; },
        {"1", "Directions in which the energy falls; 0: a minimum"}, target);
    write<std::int64_t>(
        to, "neutral", all, [](const E& e) { return e.neutral; },
        {"1", "Directions in which it does not change to second order"}, target);
    write<std::uint64_t>(
        to, "found", all, [](const E& e) { return e.found; },
        {"1", "Starts that led here, or to a symmetric copy"}, target);
    write<std::uint64_t>(
        to, "first", all, [](const E& e) { return e.first; },
        {"1", "Trajectory whose start first led here"}, target);
    std::vector<ParticleRow> particles;
    std::vector<ModeRow> modes;
    for (std::uint64_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = 0; k < all[i].positions.size(); ++k)
        particles.push_back({i, all[i].positions[k].x, all[i].positions[k].y, all[i].walls[k]});
      for (const NormalMode& m : all[i].modes) modes.push_back({i, m});
    }
    using P = ParticleRow;
    const Handle places = file.group("equilibria/particles", "Their particles, in order");
    write<std::uint64_t>(
        places.get(), "equilibrium", particles, [](const P& p) { return p.equilibrium; },
        {"1", "Row of /equilibria"}, target);
    write<double>(
        places.get(), "x", particles, [](const P& p) { return p.x; }, {"length", "Position"},
        target);
    write<double>(
        places.get(), "y", particles, [](const P& p) { return p.y; }, {"length", "Position"},
        target);
    write<std::int64_t>(
        places.get(), "wall", particles, [](const P& p) { return p.wall; },
        {"1", "Index of the wall that holds it; -1: none"}, target);
    using M = ModeRow;
    const Handle motions =
        file.group("equilibria/modes", "Their small motions exp((growth + i frequency) t)");
    write<std::uint64_t>(
        motions.get(), "equilibrium", modes, [](const M& m) { return m.equilibrium; },
        {"1", "Row of /equilibria"}, target);
    write<double>(
        motions.get(), "frequency", modes, [](const M& m) { return m.mode.frequency; },
        {"1/time", "Angular frequency"}, target);
    write<double>(
        motions.get(), "growth", modes, [](const M& m) { return m.mode.growth; },
        {"1/time", "Rate of growth"}, target);
    const Handle provenance = file.open_group("provenance");
    hdf5::change_attribute(provenance.get(), "threads", std::int64_t{result.threads}, target);
  }
  file.write_seconds({result.seconds, result.cpu_seconds});
  file.set_status(result.complete ? "completed" : "interrupted", result.complete);
  file.keep_as(target);
  give_up_checkpoint(target);
}

StoredEquilibria read_equilibria(const std::string& name) {
  const Handle file =
      open_archive(name, "the file is not an archive", "an archive written by carom relax -o");
  if (hdf5::read_string_attribute(file.get(), "kind", name) != relax_archive_kind)
    throw InputError(Place{name, 0, 0, ""}, "the archive holds no equilibria",
                     "an archive written by carom relax -o");
  hdf5::verify(file.get(), name);
  StoredEquilibria stored;
  stored.system_toml = hdf5::read_text(file.get(), "system", name);
  const Handle provenance = open_group(file.get(), "provenance");
  stored.system_name = hdf5::read_string_attribute(provenance.get(), "system", name);
  RelaxResult& result = stored.result;
  result.complete = hdf5::read_integer_attribute(file.get(), "complete", name) != 0;
  result.threads =
      static_cast<int>(hdf5::read_integer_attribute(provenance.get(), "threads", name));
  const Seconds seconds = ArchiveFile::read_seconds(provenance.get(), name);
  result.seconds = seconds.wall;
  result.cpu_seconds = seconds.cpu;
  const Handle group = open_group(file.get(), "equilibria"),
               particles = open_group(file.get(), "equilibria/particles"),
               modes = open_group(file.get(), "equilibria/modes");
  const auto reals = [&](const Handle& from, const char* column) {
    return hdf5::read_column<double>(from.get(), column, name);
  };
  const auto counts = [&](const Handle& from, const char* column) {
    return hdf5::read_column<std::uint64_t>(from.get(), column, name);
  };
  const auto integers = [&](const Handle& from, const char* column) {
    return hdf5::read_column<std::int64_t>(from.get(), column, name);
  };
  result.starts = counts(group, "starts").at(0);
  result.without = counts(group, "without").at(0);
  const auto energy = reals(group, "energy"), energy_error = reals(group, "energy_error"),
             position_error = reals(group, "position_error");
  const auto descending = integers(group, "descending"), neutral = integers(group, "neutral");
  const auto found = counts(group, "found"), first = counts(group, "first");
  for (std::size_t i = 0; i < energy.size(); ++i) {
    Equilibrium e;
    e.energy = energy[i];
    e.energy_error = energy_error.at(i);
    e.position_error = position_error.at(i);
    e.descending = static_cast<int>(descending.at(i));
    e.neutral = static_cast<int>(neutral.at(i));
    e.found = found.at(i);
    e.first = first.at(i);
    result.equilibria.push_back(std::move(e));
  }
  const auto of_particle = counts(particles, "equilibrium"), of_mode = counts(modes, "equilibrium");
  const auto x = reals(particles, "x"), y = reals(particles, "y");
  const auto wall = integers(particles, "wall");
  for (std::size_t i = 0; i < x.size(); ++i) {
    Equilibrium& e = result.equilibria.at(of_particle.at(i));
    e.positions.push_back({x[i], y.at(i)});
    e.walls.push_back(static_cast<int>(wall.at(i)));
  }
  const auto frequency = reals(modes, "frequency"), growth = reals(modes, "growth");
  for (std::size_t i = 0; i < frequency.size(); ++i)
    result.equilibria.at(of_mode.at(i)).modes.push_back({frequency[i], growth.at(i)});
  return stored;
}

}  // namespace carom
