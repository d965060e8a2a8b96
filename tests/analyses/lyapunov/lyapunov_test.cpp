// Lyapunov exponents: against known tables, regular ones, and themselves in lanes and in parts.
#include "carom/analyses/lyapunov.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/base/error.hpp"

namespace carom {
namespace {

System system_of(const std::string& table, double t_max, std::uint64_t trajectories,
                 const std::string& more = "") {
  return make_system("[table]\n" + table + "\n" + more +
                     "\n[run]\nt_max = " + std::to_string(t_max) +
                     "\ntrajectories = " + std::to_string(trajectories) + "\n");
}
const char* const stadium = "shape = \"stadium\"\nhalf_length = 1\nradius = 1";
const char* const mushroom =
    "shape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1";
const char* const ellipse = "shape = \"ellipse\"\na = 1\nb = 0.75";

LyapunovResult run(const System& system, std::optional<InstructionSet> lanes = {}, int threads = 1,
                   std::uint64_t block = 64) {
  LyapunovOptions how;
  how.lanes = lanes;
  how.threads = threads;
  how.block = block;
  return run_lyapunov(system, how);
}
void expect_near(const Estimate& e, double truth, double own_error = 0.0) {
  EXPECT_NEAR(e.value, truth, 4.0 * std::hypot(e.error, own_error));
  EXPECT_LT(e.error, 0.02 * truth);
}

TEST(Lyapunov, KnownTables) {
  const LyapunovEstimate cap = estimate_of(run(system_of(stadium, 1000, 300)).growth);
  expect_near(cap.per_time, 0.4297, 0.0002);
  expect_near(cap.per_hit, 0.9375, 0.0005);
  const LyapunovEstimate torus = estimate_of(
      run(system_of("shape = \"lorentz\"\nlattice = \"square\"\nspacing = 1\nradius = 0.4", 200,
                    300))
          .growth);
  expect_near(torus.per_time, 2.73845, 0.0004);
  expect_near(torus.per_hit, 1.7026, 0.0003);
  const LyapunovEstimate gas = estimate_of(
      run(system_of("shape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1", 200,
                    300))
          .growth);
  expect_near(gas.per_time, 2.1046, 0.0001);
  expect_near(gas.per_hit, 1.1049, 0.0001);
}

TEST(Lyapunov, RegularTablesHaveNone) {
  for (const char* const field : {"", "[field]\nB = 0.7"})
    for (const char* const table :
         {"shape = \"circle\"\nradius = 1", "shape = \"rectangle\"\nwidth = 1\nheight = 2"}) {
      const std::string text = table;
      if (text.find("rect") != std::string::npos && *field != 0) continue;  // mixed
      const LyapunovResult r = run(system_of(table, 4000, 200, field));
      const LyapunovEstimate e = estimate_of(system_of(table, 4000, 200, field), r);
      EXPECT_EQ(e.law, LyapunovEstimate::Law::linear) << table << field;
      EXPECT_EQ(e.per_time.value, 0.0) << table << field;
      EXPECT_EQ(e.per_time.error, 0.0) << table << field;
      EXPECT_EQ(e.chaotic_share.value, 0.0) << table << field;
      EXPECT_LT(mean_growth_of(r.growth).per_time.value, 0.002) << table << field;
      EXPECT_EQ(r.growth.totals().chaotic, 0u) << table << field;
      EXPECT_EQ(r.growth.totals().linear, 200u) << table << field;
    }
  // All but the orbits next to the separatrix.
  const LyapunovResult r = run(system_of(ellipse, 4000, 300));
  EXPECT_LE(r.growth.totals().chaotic, 1u);
  EXPECT_GE(r.growth.totals().linear, 297u);
}

// What the table does not tell, the deviations do: in the cap of a mushroom they grow linearly.
TEST(Lyapunov, OrbitsThatGrowLinearlyHaveNone) {
  const auto in_cap = [](double t_max) {
    System system = system_of(mushroom, t_max, 1);
    system.initial.kind = InitialCondition::Kind::point;
    system.initial.position = {0.9, 0.1};
    system.initial.velocity = {0.1, 1.0};
    return estimate_of(system, run(system));
  };
  const LyapunovEstimate regular = in_cap(4000);
  EXPECT_EQ(regular.law, LyapunovEstimate::Law::linear);
  EXPECT_EQ(regular.per_time.value, 0.0);
  EXPECT_GT(regular.would_show, 0.0);
  EXPECT_TRUE(std::isnan(regular.chaotic_share.value));
  EXPECT_EQ(in_cap(20).law, LyapunovEstimate::Law::unknown);
}

// Chaotic orbits take some 28 / (2 lambda) to show: before, none is regular and there is no share.
TEST(Lyapunov, ShortRunsTellNoShare) {
  const char* const sinai = "shape = \"lorentz\"\nlattice = \"square\"\nspacing = 1\nradius = 0.4";
  for (const char* const table : {stadium, mushroom, sinai})
    for (const double t : {2.0, 5.0, 20.0, 40.0, 100.0, 400.0}) {
      const bool tells = t > (table == sinai ? 30.0 : 200.0);
      if (table == sinai && t == 20.0) continue;  // about where it begins
      const System system = system_of(table, t, 1000);
      const LyapunovEstimate e = estimate_of(system, run(system));
      EXPECT_EQ(e.tells_regular, tells) << table << t;
      EXPECT_EQ(std::isfinite(e.chaotic_share.value), tells) << table << t;
      if (!tells) continue;
      const double truth = table == mushroom ? 1.0 - 0.2389084047 : 1.0;
      EXPECT_LE(e.share_interval.low, truth) << table << t;
      EXPECT_GE(e.share_interval.high, truth) << table << t;
    }
}

TEST(Lyapunov, AMushroomIsDividedSharply) {
  const LyapunovResult r = run(system_of(mushroom, 2000, 1000));
  const LyapunovEstimate e = estimate_of(r.growth);
  EXPECT_GE(r.growth.totals().linear, 200u);
  EXPECT_NEAR(e.chaotic_share.value, 1.0 - 0.2389084047, 4 * e.chaotic_share.error);
  EXPECT_LT(e.chaotic_share.error, 0.02);
  EXPECT_GT(e.chaotic.value, 1.2 * e.per_time.value);
}

// Everything that a run adds up, in one number each.
void expect_same(const LyapunovResult& a, const LyapunovResult& b) {
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.collisions, b.collisions);
  EXPECT_EQ(a.done, b.done);
  const GrowthSums::Totals &x = a.growth.totals(), &y = b.growth.totals();
  EXPECT_EQ(x.orbits, y.orbits);
  EXPECT_EQ(x.chaotic_at, y.chaotic_at);
  EXPECT_EQ(x.growth.state(), y.growth.state());
  EXPECT_EQ(x.distribution.counts(), y.distribution.counts());
  for (std::size_t i = 0; i < x.levels.size(); ++i)
    EXPECT_EQ(x.levels[i].product.state(), y.levels[i].product.state());
  ASSERT_EQ(a.growth.parts().size(), b.growth.parts().size());
  std::uint64_t orbits = 0;
  for (std::size_t r = 0; r < a.growth.parts().size(); ++r) {
    orbits += a.growth.parts()[r].orbits;
    EXPECT_EQ(a.growth.parts()[r].orbits, b.growth.parts()[r].orbits);
    EXPECT_EQ(a.growth.parts()[r].chaotic_at, b.growth.parts()[r].chaotic_at);
    EXPECT_EQ(a.growth.parts()[r].growth.state(), b.growth.parts()[r].growth.state());
  }
  if (!a.growth.parts().empty()) {
    EXPECT_EQ(orbits, x.orbits);
  }
}

System quasi_random(System system) {
  system.initial.kind = InitialCondition::Kind::sobol;
  return system;
}

TEST(Lyapunov, HasTheSameBitsInLanesAndThreads) {
  const System systems[] = {
      system_of(stadium, 50, 200),
      system_of(mushroom, 50, 200, "[field]\nB = 0.3"),
      system_of(ellipse, 50, 200),
      system_of(ellipse, 50, 200, "[field]\nB = -1.3"),
      system_of("shape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1", 30, 200,
                "[field]\nB = 1.2"),
      make_system(magnetic_square),
      quasi_random(system_of(mushroom, 50, 200))};
  for (const System& system : systems) {
    const LyapunovResult scalar = run(system);
    EXPECT_FALSE(scalar.lanes);
    for (const InstructionSet set : available_instruction_sets())
      expect_same(run(system, set, set == InstructionSet::baseline ? 3 : 2, 7), scalar);
  }
}

TEST(Lyapunov, PartsAddUpToTheWhole) {
  for (const System& system :
       {system_of(stadium, 100, 90), quasi_random(system_of(stadium, 100, 90))}) {
    const LyapunovResult whole = run(system);
    LyapunovResult sum;
    for (const std::uint64_t k : {3u, 1u, 2u}) {
      LyapunovOptions how;
      how.part = shard(k, 3, 90);
      const LyapunovResult part = run_lyapunov(system, how);
      if (k == 3)
        sum = part;
      else
        EXPECT_TRUE(sum.add(part));
    }
    expect_same(sum, whole);
  }
}

// Keeps records as they come.
class Kept : public LyapunovJournal {
 public:
  bool wants_records() const override { return true; }
  void block(TrajectoryRange, std::vector<TrajectoryRecord>&& records) override {
    all.insert(all.end(), records.begin(), records.end());
  }
  void save(const LyapunovResult&) override {}
  std::vector<TrajectoryRecord> all;
};

// The mean of the records is the result, and each says what became of its particle.
TEST(Lyapunov, RecordsAddUpToTheResult) {
  const System system =
      make_system("[table]\n" + std::string(mushroom) +
                  "\n[initial]\nkind = \"boundary\"\nwall = \"cap\"\n[run]\nt_max = 500\n"
                  "trajectories = 100\n");
  Kept kept;
  LyapunovOptions how;
  how.threads = 2;
  how.journal = &kept;
  const LyapunovResult result = run_lyapunov(system, how);
  ASSERT_EQ(kept.all.size(), 100u);
  double sum = 0.0;
  std::uint64_t chaotic = 0;
  for (const TrajectoryRecord& r : kept.all) {
    sum += r.lambda;
    const bool is_chaotic = r.regularity == static_cast<unsigned char>(Regularity::chaotic);
    chaotic += is_chaotic;
    EXPECT_TRUE(!is_chaotic || r.sali < 1e-8) << r.sali;
    EXPECT_TRUE(is_chaotic || r.sali > 1e-16) << r.sali;
    EXPECT_GE(r.wall, 0);
    EXPECT_LE(std::fabs(r.v_parallel), 1.0);
    EXPECT_GE(r.s, 0.0);
  }
  EXPECT_NEAR(sum / 100.0, mean_growth_of(result.growth).per_time.value, 1e-12);
  EXPECT_EQ(chaotic, result.growth.totals().chaotic);
}

// Orbits that leave before the window's end say nothing of it.
TEST(Lyapunov, CountsOrbitsThatStay) {
  const LyapunovResult r = run(make_system(magnetic_square));
  EXPECT_EQ(r.growth.totals().orbits, r.survived);
  EXPECT_GT(r.escaped, 0u);
  System none = make_system(magnetic_square);
  none.run.trajectories = 3;
  none.initial.kind = InitialCondition::Kind::hole;
  none.initial.hole = 0;
  none.run.t_max = 1e6;
  const LyapunovResult left = run(none);
  EXPECT_EQ(left.growth.totals().orbits, 0u);
  EXPECT_TRUE(std::isnan(estimate_of(left.growth).per_time.value));
}

const char* const henon_heiles = R"toml(
[particles]
energy = 0.125
[[potential]]
kind = "henon-heiles"
[integrator]
step = 0.1
)toml";

TEST(Lyapunov, HenonHeiles) {
  const auto exponent = [](double y, double t_max) {
    System system = make_system(std::string(henon_heiles) +
                                "[initial]\nkind = \"point\"\nposition = [0, " + std::to_string(y) +
                                "]\nvelocity = [1, 0]\n[run]\nt_max = " + std::to_string(t_max) +
                                "\ntrajectories = 1\n");
    return run(system).growth;
  };
  const LyapunovEstimate chaotic = estimate_of(exponent(-0.25, 20000));
  EXPECT_NEAR(chaotic.per_time.value, 0.044, 4 * std::hypot(chaotic.per_time.error, 0.001));
  EXPECT_EQ(chaotic.chaotic_share.value, 1.0);
  const LyapunovEstimate regular = estimate_of(exponent(0.55, 20000));
  EXPECT_EQ(regular.law, LyapunovEstimate::Law::linear);
  EXPECT_EQ(regular.per_time.value, 0.0);
  EXPECT_LT(regular.would_show, 0.001);
}

TEST(Lyapunov, RefusesWhatItCannotFollow) {
  System system = system_of(stadium, 10, 10);
  system.run.window = {{2.0, 11.0}};
  EXPECT_THROW(run(system), InputError);
  system.run.window.reset();
  system.dynamics.everywhere = true;
  system.dynamics.integrator.scheme = "arkode";
  EXPECT_THROW(run(system), InputError);
}

}  // namespace
}  // namespace carom
