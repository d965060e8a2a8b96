// Where the discs of a lattice are written does not matter: many cells away they are the same
// lattice.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/analyses/run.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"
#include "recorder.hpp"

namespace carom {
namespace {

using geometry::Vector;
using tests::Recorder;

Vector in_plane(const System& system, const HitEvent& hit) {
  return hit.position + system.table->lattice->translation(hit.cell);
}

/// The second disc is written `away` from [1/2, 1/2], a whole number of cells.
LoadedSystem discs(Vector away, const std::string& vectors, const std::string& rest) {
  const auto shown = [](double x) { return std::to_string(x); };
  return read_system("[table]\nshape = \"discs\"\ncenters = [[0, 0], [" + shown(0.5 + away.x) +
                         ", " + shown(0.5 + away.y) + "]]\nradius = 0.3\n[lattice]\nvectors = " +
                         vectors + "\n" + rest + "[run]\nt_max = 2.5\n",
                     "discs");
}

// Whole numbers of cells for both pairs of vectors.
const Vector far[] = {{3, 0}, {41, 0}, {-40, 17}, {0, 1000}, {-150, 90}};

TEST(FarDiscs, PointsAreInsideAndHitTheSameDiscs) {
  for (const char* vectors : {"[[1, 0], [0, 1]]", "[[1, 0], [3, 1]]"})
    for (const char* start : {"[0.5, 0]", "[-20.53, 7.03]", "[40.47, 0.02]"})
      for (const char* field : {"", "[field]\nB = 0.75\n"}) {
        const std::string rest = std::string("[initial]\nkind = \"point\"\nposition = ") + start +
                                 "\nvelocity = [0.125, 1]\n" + field;
        const LoadedSystem here = discs({0, 0}, vectors, rest);
        Recorder expected;
        World near(*here.system.table);
        near.add(here.system.particles[0], Sampler(here.system).draw(near, 0, 0));
        near.run_until(2.5, expected);
        ASSERT_GE(expected.hits.size(), 6u);
        for (const Vector away : far) {
          const LoadedSystem there = discs(away, vectors, rest);
          Recorder found;
          World world(*there.system.table);
          world.add(there.system.particles[0], Sampler(there.system).draw(world, 0, 0));
          world.run_until(2.5, found);
          ASSERT_EQ(found.hits.size(), expected.hits.size()) << vectors << start << field << away.x;
          EXPECT_EQ(world.fate(0), near.fate(0));
          for (std::size_t i = 0; i < found.hits.size(); ++i) {
            EXPECT_EQ(found.hits[i].wall, expected.hits[i].wall);
            const Vector off =
                in_plane(there.system, found.hits[i]) - in_plane(here.system, expected.hits[i]);
            EXPECT_LT(std::sqrt(dot(off, off)), 1e-8) << vectors << start << field << away.x;
          }
        }
      }
}

// The start is seen from another cell than it was written in.
TEST(FarDiscs, AreTrustedAsFarAsNearOnes) {
  const std::string rest =
      "[initial]\nkind = \"point\"\nposition = [0.5, 0]\nvelocity = [0.125, 1]\n";
  Observer silent;
  const auto trust = [&](Vector away) {
    LoadedSystem loaded = discs(away, "[[1, 0], [0, 1]]", rest);
    loaded.system.run.t_max = 30.0;
    SingleRunOptions options;
    options.written = written_system(loaded);
    return run_single(loaded.system, silent, options).particles.front().trust;
  };
  const Trust near = trust({0, 0});
  ASSERT_GT(near.hits, 15u);
  for (const Vector away : {Vector{3, 0}, Vector{41, 0}}) {
    const Trust found = trust(away);
    EXPECT_GE(found.hits + 4, near.hits) << away.x;  // each hit multiplies what was rounded by 10
    EXPECT_FALSE(found.open);
  }
}

}  // namespace
}  // namespace carom
