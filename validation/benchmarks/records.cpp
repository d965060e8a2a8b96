// Records of a run: what it costs to store each hit of an orbit. What is read back must be what was
// computed.
#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <carom/carom.hpp>
#include <filesystem>
#include <string>

#include "measuring.hpp"
#include "table.hpp"

namespace carom::bench {

namespace {

constexpr std::uint64_t hits = 1'000'000;

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 29;
}
std::uint64_t mixed(std::uint64_t hash, const HitRow& r) {
  for (const double x : {r.s, r.v_parallel, r.t, r.x, r.y, r.vx, r.vy})
    hash = mixed(hash, std::bit_cast<std::uint64_t>(x));
  for (const std::int64_t n : {std::int64_t{r.particle}, std::int64_t{r.wall}, r.cell_first,
                               r.cell_second, std::int64_t{r.reflections}})
    hash = mixed(hash, static_cast<std::uint64_t>(n));
  return hash;
}

/// Rows as they are computed.
class Hashed : public Observer {
 public:
  explicit Hashed(const Table& table) : table_(table), frames_(frames_of(table)) {}
  void hit(const HitEvent& event) override { hash = mixed(hash, hit_row(event, table_, frames_)); }
  std::uint64_t hash = 0;

 private:
  const Table& table_;
  const std::vector<geometry::CurveFrame> frames_;
};

void measure_row(Report& report, const char* name) {
  SystemOverrides overrides;
  overrides.set = {{"table.hole", "[]"}};
  overrides.collisions = fmt::format("{}", hits);
  overrides.t_max = fmt::format("{}", no_last_time);
  const LoadedSystem loaded = load_system(name, overrides);
  const System& system = loaded.system;
  const std::string path =
      (std::filesystem::temp_directory_path() / fmt::format("carom-bench-{}.h5", getpid()))
          .string();
  const auto done = static_cast<double>(hits);
  Best plain, stored;
  plain.repeat(3, [&] {
    Observer nothing;
    run_single(system, nothing, {});
    return done;
  });
  prepare_archives();
  stored.repeat(3, [&] {
    const auto archive =
        RunArchive::create(path, loaded, {"bench", "events", "baseline", 1, {}}, true);
    const SingleRunResult result = run_single(system, *archive, {});
    archive->finish(result, "completed");
    return done;
  });
  const double bytes = static_cast<double>(std::filesystem::file_size(path)) / done;
  std::uint64_t read = 0;
  for (const HitRow& row : read_hits(path)) read = mixed(read, row);
  std::filesystem::remove(path);
  Hashed computed(*system.table);
  run_single(system, computed, {});
  const bool same = read == computed.hash;
  report.add({fmt::format("records {}, a hit", name), "HDF5", stored.each, stored.ratio,
              "without records", plain.each / stored.each,
              fmt::format("rows read back {}, {:.1f} bytes a hit, {:.1f} million hits a second",
                          same ? "equal" : "DIFFER", bytes, 1e3 / stored.each),
              same});
}

}  // namespace

void records_of_runs(Report& report) {
  for (const char* name : {"stadium", "sinai"})
    if (report.wants(fmt::format("records {}", name))) measure_row(report, name);
}

}  // namespace carom::bench
