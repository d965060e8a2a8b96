// /energy of a run's archive, against what the samples in /trajectory give.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/analyses/run.hpp"
#include "carom/analyses/run/archive.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/system_file.hpp"
#include "program.hpp"

namespace carom {
namespace {

/// One run with samples of its particles, row = sample * particles + particle.
class Archive {
 public:
  Archive(const Shell& shell, const std::string& name)
      : file_(H5Fopen((shell.folder() + "/" + name).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  Archive(const Archive&) = delete;
  ~Archive() { H5Fclose(file_); }

  std::vector<double> column(const std::string& name) const {
    const hid_t data = H5Dopen2(file_, name.c_str(), H5P_DEFAULT), space = H5Dget_space(data);
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Sclose(space);
    H5Dclose(data);
    return values;
  }

 private:
  hid_t file_;
};

struct Case {
  const char* options;
  std::size_t particles;
  std::vector<double> mass, charge;
  double stiffness;  ///< V = stiffness r^2 m / 2
  double field;
};

TEST(EnergyArchive, AgreesWithTheSamples) {
  const Case cases[] = {
      {"coulomb-circle --t-max 2 --set run.sample=0.1", 15, {}, {}, 0.0, 0.0},
      {"wigner --t-max 20 --set run.sample=1 --set integrator.step=0.001 --set field.B=0.5 --set "
       "'particles.mass=[1,2,3,1,0.5]' "
       "--set 'particles.charge=[1,1,2,3,1]' --set particles.energy=20",
       5,
       {1, 2, 3, 1, 0.5},
       {1, 1, 2, 3, 1},
       2.0,
       0.5},
  };
  for (const Case& c : cases) {
    const Shell shell;
    const Outcome o = shell(std::string("$carom run ") + c.options + " -o a.h5");
    ASSERT_EQ(o.status, 0) << o.err;
    const Archive file(shell, "a.h5");
    const auto x = file.column("trajectory/x"), y = file.column("trajectory/y"),
               vx = file.column("trajectory/vx"), vy = file.column("trajectory/vy"),
               time = file.column("trajectory/t");
    const auto t = file.column("energy/t"), kinetic = file.column("energy/kinetic"),
               external = file.column("energy/external"), pair = file.column("energy/pair"),
               total = file.column("energy/total"), px = file.column("energy/px"),
               py = file.column("energy/py"), turning = file.column("energy/angular_momentum");
    ASSERT_EQ(t.size(), 21u);
    ASSERT_EQ(x.size(), t.size() * c.particles);
    for (std::size_t i = 0; i < t.size(); ++i) {
      double k = 0.0, v = 0.0, w = 0.0, ux = 0.0, uy = 0.0, l = 0.0;
      for (std::size_t p = 0; p < c.particles; ++p) {
        const std::size_t a = i * c.particles + p;
        EXPECT_EQ(time[a], t[i]);
        const double m = c.mass.empty() ? 1.0 : c.mass[p], q = c.charge.empty() ? 1.0 : c.charge[p];
        const double r2 = x[a] * x[a] + y[a] * y[a];
        k += 0.5 * m * (vx[a] * vx[a] + vy[a] * vy[a]);
        v += 0.5 * m * c.stiffness * r2;
        ux += m * vx[a];
        uy += m * vy[a];
        l += m * (x[a] * vy[a] - y[a] * vx[a]) + 0.5 * q * c.field * r2;
        for (std::size_t other = 0; other < p; ++other) {
          const std::size_t b = i * c.particles + other;
          w +=
              q * (c.charge.empty() ? 1.0 : c.charge[other]) / std::hypot(x[a] - x[b], y[a] - y[b]);
        }
      }
      const double size = std::fabs(total[i]);
      EXPECT_NEAR(kinetic[i], k, 1e-14 * size);
      EXPECT_NEAR(external[i], v, 1e-14 * size);
      EXPECT_NEAR(pair[i], w, 1e-14 * size);
      EXPECT_NEAR(total[i], k + v + w, 1e-14 * size);
      EXPECT_NEAR(px[i], ux, 1e-14 * size);
      EXPECT_NEAR(py[i], uy, 1e-14 * size);
      EXPECT_NEAR(turning[i], l, 1e-14 * size);
      EXPECT_NEAR(total[i] / total[0], 1.0, 1e-10) << c.options << " t = " << t[i];
      // Walls and well are round.
      EXPECT_NEAR(turning[i], turning[0], 1e-12 * size) << c.options << " t = " << t[i];
    }
  }
}

TEST(EnergyArchive, GoesOnAfterAPause) {
  const Shell shell;
  const std::string run = "$carom run wigner --set run.sample=0.37 --set particles.energy=8 ";
  const Outcome o = shell(run + "--t-max 20 -o whole.h5 && " + run +
                          "--t-max 7 -o part.h5 && $carom run --resume part.h5 --t-max 20");
  ASSERT_EQ(o.status, 0) << o.err;
  const Archive whole(shell, "whole.h5"), part(shell, "part.h5");
  for (const char* name :
       {"t", "kinetic", "external", "pair", "total", "px", "py", "angular_momentum"})
    EXPECT_EQ(whole.column(std::string("energy/") + name),
              part.column(std::string("energy/") + name))
        << name;
}

// Enough pairs for a question at each sum.
const char* crowd = R"([table]
shape = "circle"
radius = 100
[particles]
count = 1500
speed = 1
[interaction]
kind = "coulomb"
strength = 0.001
[integrator]
scheme = "velocity-verlet"
step = 0.001
unresolved = "count"
[run]
t_max = 0.003
sample = 0.001
)";

// A signal that comes while the pairs of a sample are summed: the sample is not stored, not even
// its positions, and the run that goes on stores it.
TEST(EnergyArchive, StoresASampleWholeOrNotAtAll) {
  const Shell shell;
  const LoadedSystem loaded = read_system(crowd, "crowd.toml");
  for (const std::string name : {"whole.h5", "part.h5"}) {
    const std::string file = shell.folder() + "/" + name;
    bool signalled = false;
    int sums = 0;
    SingleRunOptions how;
    how.interrupted = [&] { return signalled; };
    auto archive = RunArchive::create(file, loaded, Provenance{}, false);
    if (name == "part.h5") archive->listen([&] { return signalled = signalled || ++sums > 2; });
    const SingleRunResult first = run_single(loaded.system, *archive, how);
    archive->finish(first, "completed");
    EXPECT_EQ(first.interrupted, name == "part.h5");
    if (!first.interrupted) continue;
    {
      const Archive part(shell, name);
      const auto energies = part.column("energy/t").size();
      EXPECT_GT(energies, 0u);
      EXPECT_LT(energies, 4u);
      EXPECT_EQ(part.column("trajectory/t").size(), 1500 * energies);
    }
    const StoredRun stored = read_run(file);
    SingleRunOptions again;
    again.resume = stored.particles;
    again.steps = stored.steps;
    archive = RunArchive::extend(file, file, loaded, Provenance{}, true);
    archive->finish(run_single(loaded.system, *archive, again), "completed");
  }
  const Archive whole(shell, "whole.h5"), part(shell, "part.h5");
  EXPECT_EQ(whole.column("energy/t").size(), 4u);
  for (const char* name : {"energy/t", "energy/total", "trajectory/t", "trajectory/x"})
    EXPECT_EQ(whole.column(name), part.column(name)) << name;
}

TEST(EnergyArchive, IsThereOnlyWhereForcesAct) {
  const Shell shell;
  ASSERT_EQ(shell("$carom run sinai --t-max 5 --set run.sample=1 -o a.h5").status, 0);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t file = H5Fopen((shell.folder() + "/a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_EQ(H5Lexists(file, "energy", H5P_DEFAULT), 0);
  H5Fclose(file);
}

}  // namespace
}  // namespace carom
