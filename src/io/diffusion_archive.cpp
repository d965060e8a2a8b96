#include <span>

#include "io/archive_file.hpp"

namespace carom {

using hdf5::Description;
using hdf5::Handle;

class DiffusionArchive::Implementation {
 public:
  Implementation(const std::string& path, const LoadedSystem& loaded, const Provenance& origin)
      : target(path), file(ArchiveFile::create(path + ".part", path)) {
    file.write_head("diffusion", loaded, origin);
  }

  template <class Get>
  void column(const Handle& group, const char* name, const std::vector<MomentPoint>& points, Get get,
              Description description) {
    std::vector<std::decay_t<decltype(get(points.front()))>> values;
    for (const MomentPoint& point : points) values.push_back(get(point));
    hdf5::write_column(group.get(), name, std::span(std::as_const(values)), description, target);
  }

  std::string target;
  ArchiveFile file;
};

DiffusionArchive::DiffusionArchive(const std::string& file, const LoadedSystem& loaded,
                                   const Provenance& origin, bool force) {
  refuse_existing(file, force);
  implementation_ = std::make_unique<Implementation>(file, loaded, origin);
}
DiffusionArchive::~DiffusionArchive() = default;

void DiffusionArchive::finish(const DiffusionResult& result, const std::vector<MomentPoint>& points,
                              const std::string& status) {
  Implementation& a = *implementation_;
  {
    using Point = const MomentPoint&;
    const Handle g = a.file.group("msd", "Moments of the displacement in the plane since t = 0");
    a.column(g, "t", points, [](Point p) { return p.t; }, {"time", "Time"});
    a.column(g, "count", points, [](Point p) { return p.count; }, {"1", "Particles there at t"});
    a.column(g, "value", points, [](Point p) { return p.square.value; },
             {"length^2", "Mean square displacement"});
    a.column(g, "stderr", points, [](Point p) { return p.square.error; }, {"length^2", "Its standard error"});
    a.column(g, "fourth", points, [](Point p) { return p.fourth.value; },
             {"length^4", "Mean fourth power of the displacement"});
    a.column(g, "fourth_stderr", points, [](Point p) { return p.fourth.error; },
             {"length^4", "Its standard error"});
    a.column(g, "exponent", points, [](Point p) { return p.exponent.value; },
             {"1", "d ln MSD / d ln t since the time before; NaN where there is none"});
    a.column(g, "exponent_stderr", points, [](Point p) { return p.exponent.error; },
             {"1", "Its standard error"});
    // Group by group, for errors of whatever is computed from the moments.
    std::vector<std::uint64_t> counts;
    std::vector<double> squares;
    for (std::size_t group = 0; group < DisplacementSums::groups; ++group) {
      for (std::size_t k = 0; k < points.size(); ++k) {
        const DisplacementSums::Sum& sum = result.sums.of(group, k);
        counts.push_back(sum.count);
        squares.push_back(sum.square.value());
      }
    }
    const Handle by = a.file.group("msd_groups",
                                   "Sums by group of trajectories (index modulo 128): row group * times + time");
    hdf5::write_column(by.get(), "count", std::span<const std::uint64_t>(counts), {"1", "Particles there at t"},
                       a.target);
    hdf5::write_column(by.get(), "square", std::span<const double>(squares),
                       {"length^2", "Sum of their squared displacements"}, a.target);
    const Handle ends = a.file.group("fates", "Numbers of particles by their end before the last report time");
    const auto number = [&](const char* name, std::uint64_t value, const char* text) {
      hdf5::write_column(ends.get(), name, std::span<const std::uint64_t>(&value, 1), {"1", text}, a.target);
    };
    number("trajectories", result.trajectories, "All particles of all trajectories");
    number("survived", result.survived, "Still there at the end");
    number("pinned", result.pinned, "Survivors on a cyclotron orbit that never hits");
    number("escaped", result.escaped, "Left through a hole");
    number("capped", result.capped, "Ended by the cap on hits");
    number("singular", result.singular, "Ended where no continuation is defined");
    number("unbounded", result.unbounded, "No wall follows any more");
    number("lost", result.lost, "Internal errors: always 0");
    number("collisions", result.collisions, "Reflections of all particles");
    number("digest", result.digest, "Sum of a hash of each trajectory: equal digests, equal bits");
    const Handle provenance = a.file.open_group("provenance");
    hdf5::change_attribute(provenance.get(), "threads", std::int64_t{result.threads}, a.target);
  }
  a.file.add_decisions(result.decisions);
  a.file.set_status(status, result.complete);
  a.file.keep_as(a.target);
}

}  // namespace carom
