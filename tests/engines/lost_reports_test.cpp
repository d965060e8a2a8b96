// Which lost particles are reported: those of the lowest indices, in every way to run the ensemble.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "analyses/escape/records.hpp"
#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"

namespace carom {
namespace {

TEST(LostReports, AreThoseOfTheLowestIndices) {
  const System system = make_system(std::string(defined_in_the_right_half) +
                                    "[run]\nt_max = 0.5\ntrajectories = 400\n");
  EscapeOptions options;
  options.threads = 1;
  std::vector<TrajectoryRecord> records;
  const EscapeResult one = run_escape(system, options, records);
  ASSERT_GT(one.counts.unresolved, 20u);
  ASSERT_LT(one.counts.unresolved, 400u);
  std::vector<std::uint64_t> first;
  for (const TrajectoryRecord& r : records)
    if (r.fate == Fate::unresolved && first.size() < most_reports) first.push_back(r.index);
  ASSERT_EQ(one.reports.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(one.reports[i].first, first[i]);
  for (const InstructionSet set : available_instruction_sets())
    for (const std::uint64_t block : {7u, 100u, 1000u}) {
      EscapeOptions how;
      how.threads = block == 100 ? 3 : 1;
      how.block = block;
      how.lanes = set;
      EXPECT_EQ(run_escape(system, how).reports, one.reports) << block;
      DiffusionOptions diffusion;
      diffusion.threads = how.threads;
      diffusion.block = block;
      diffusion.lanes = set;
      EXPECT_EQ(run_diffusion(system, diffusion).reports, one.reports) << block;
    }
}

}  // namespace
}  // namespace carom
