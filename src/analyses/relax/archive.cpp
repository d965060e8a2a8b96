#include "carom/analyses/relax.hpp"

#include <span>
#include <vector>

#include "files/hdf5/archive_file.hpp"
#include "files/hdf5/fields.hpp"

namespace carom {

using namespace files;
using hdf5::Handle;

namespace {

constexpr const char* relax_archive_kind = "relax";

// A particle of an equilibrium, and one of its motions.
struct ParticleRow {
  std::uint64_t equilibrium = 0;
  double x = 0.0, y = 0.0;
  std::int64_t wall = -1;
};
struct ModeRow : NormalMode {
  std::uint64_t equilibrium = 0;
};

}  // namespace

template <>
struct Fields<ParticleRow> {
  using P = ParticleRow;
  static constexpr std::tuple list{
      field("equilibrium", "1", "Row of /equilibria", &P::equilibrium),
      field("x", "length", "Position", &P::x), field("y", "length", "Position", &P::y),
      field("wall", "1", "Index of the wall that holds it; -1: none", &P::wall)};
};
template <>
struct Fields<ModeRow> {
  static constexpr auto list = std::tuple_cat(
      std::tuple{field("equilibrium", "1", "Row of /equilibria", &ModeRow::equilibrium)},
      Fields<NormalMode>::list);
};

void write_equilibria(const std::string& target, const LoadedSystem& loaded,
                      const Provenance& origin, const RelaxResult& result, bool force,
                      ArchiveLock lock) {
  ArchiveFile file = ArchiveFile::begin(relax_archive_kind, target, loaded, origin, force, lock);
  {
    const Handle group = file.group("equilibria", "Where all forces vanish, by rising energy");
    write_numbers(group.get(), result, target);
    write_columns(group.get(), std::span(result.equilibria), target);
    std::vector<ParticleRow> particles;
    std::vector<ModeRow> modes;
    for (std::uint64_t i = 0; i < result.equilibria.size(); ++i) {
      const Equilibrium& e = result.equilibria[i];
      for (std::size_t k = 0; k < e.positions.size(); ++k)
        particles.push_back({i, e.positions[k].x, e.positions[k].y, e.walls[k]});
      for (const NormalMode& m : e.modes) modes.push_back({m, i});
    }
    write_columns(file.group("equilibria/particles", "Their particles, in order").get(),
                  std::span<const ParticleRow>(particles), target);
    write_columns(
        file.group("equilibria/modes", "Their small motions exp((growth + i frequency) t)").get(),
        std::span<const ModeRow>(modes), target);
    const Handle provenance = file.open_group("provenance");
    hdf5::change_attribute(provenance.get(), "threads", std::int64_t{result.threads}, target);
  }
  file.write_seconds({result.seconds, result.cpu_seconds});
  file.finish(result.complete ? "completed" : "interrupted", result.complete);
}

StoredEquilibria read_equilibria(const std::string& name) {
  const Handle file = open_kind(name, relax_archive_kind, "the archive holds no equilibria",
                                "an archive written by carom relax -o");
  StoredEquilibria stored;
  RelaxResult& result = stored.result;
  read_head(file.get(), name, stored, result);
  const Handle group = open_group(file.get(), "equilibria", name);
  read_numbers(group.get(), result, name);
  result.equilibria = read_all_rows<Equilibrium>(group.get(), name);
  const Handle particles = open_group(file.get(), "equilibria/particles", name),
               modes = open_group(file.get(), "equilibria/modes", name);
  for (const ParticleRow& p : read_all_rows<ParticleRow>(particles.get(), name)) {
    Equilibrium& e = result.equilibria.at(p.equilibrium);
    e.positions.push_back({p.x, p.y});
    e.walls.push_back(static_cast<int>(p.wall));
  }
  for (const ModeRow& m : read_all_rows<ModeRow>(modes.get(), name))
    result.equilibria.at(m.equilibrium).modes.push_back(m);
  return stored;
}

}  // namespace carom
