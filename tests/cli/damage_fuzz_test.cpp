// Archives of every kind with flipped bits, filled runs and copied blocks: refused by name, or read
// as they were. Many of them go through the readers alone, some through the program; with
// CAROM_SOAK many thousands.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "archive_contents.hpp"
#include "carom/analyses/kinds.hpp"
#include "carom/analyses/run/archive.hpp"
#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "damaged.hpp"
#include "files/hdf5/checksums.hpp"
#include "program.hpp"
#include "soak.hpp"
#include "systems.hpp"

namespace carom {
namespace {

const int by_readers = tests::soak() ? 4000 : 200, by_program = tests::soak() ? 500 : 12;

using tests::Cases;

const char* const ways[] = {"flipped", "filled", "copied"};

std::string damaged(std::string bytes, std::size_t way, Cases& cases) {
  constexpr std::size_t lengths[] = {1, 2, 4, 8, 16, 64, 512, 4096};
  const std::size_t length = std::min(lengths[cases.below(std::size(lengths))], bytes.size());
  const std::size_t to = cases.below(bytes.size() - length + 1);
  if (way == 0) {
    for (std::size_t k = cases.below(4) + 1; k > 0; --k)
      bytes[cases.below(bytes.size())] ^= static_cast<char>(1 << cases.below(8));
  } else if (way == 1) {
    const std::size_t value = cases.below(3);
    bytes.replace(to, length,
                  std::string(length, static_cast<char>(value == 0   ? 0
                                                        : value == 1 ? 0xff
                                                                     : cases.below(256))));
  } else {
    bytes.replace(to, length, bytes.substr(cases.below(bytes.size() - length + 1), length));
  }
  return bytes;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}
void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

struct Archive {
  const char* name;
  std::string make;                  // a shell line that leaves a.h5, and what else is needed
  std::vector<std::string> damaged;  // of its files
  std::string use,
      result;  // a shell line that reads it and may write the archive `result`; "": none does
};

void PrintTo(const Archive& archive, std::ostream* out) { *out << archive.name; }

const std::string discs =
    "cat > discs.toml <<END\n" + discs_on_a_torus +
    "t_max = 40\nEND\n";  // Killed or interrupted after its second checkpoint, when some of the
                          // trajectories are in it.
std::string unfinished(const std::string& command, const char* signal) {
  return "for i in 1 2 3 4 5 6 7 8 9; do rm -rf a.h5*; $carom " + command +
         " -o a.h5 --quiet --threads 1 --checkpoint blocks:10 & pid=$!; until_saved a.h5; kill -" +
         signal +
         " $pid; wait $pid; status=$?; [ $status = 130 -o $status = 137 ] && break; done; true";
}
const std::string run_on = "$carom run --resume a.h5 --json --quiet -o out.h5 --t-max ";
const std::string slow = "mushroom --trajectories 20000 --t-max 300 --block 50";

const Archive archives[] = {
    {"run",
     "$carom run stadium --set table.hole=[] --t-max 60 --set run.sample=0.5 -o a.h5 --quiet",
     {"a.h5"},
     run_on + "80",
     "out.h5"},
    {"run-interrupted",
     "$carom run soft-lorentz --t-max 1e9 --set run.sample=5 -o a.h5 --quiet --json > json & "
     "pid=$!; until_there a.h5; sleep 0.3; $listens_late; kill -INT $pid; wait $pid; "
     "awk '/\"t\":/ {print int($2) + 10}' json > end",
     {"a.h5"},
     run_on + "$(cat end)",
     "out.h5"},
    {"run-discs",
     discs + "$carom run discs.toml -o a.h5 --quiet",
     {"a.h5"},
     run_on + "45",
     "out.h5"},
    {"certified",
     "$carom run stadium --precision certified --collisions 40 -o a.h5 --quiet",
     {"a.h5"},
     "",
     ""},
    {"section", "$carom section stadium --orbits 3 --points 300 -o a.h5 --quiet", {"a.h5"}, "", ""},
    {"escape",
     "$carom escape stadium --trajectories 2000 --t-max 20 --per-trajectory -o a.h5 --quiet",
     {"a.h5"},
     "$carom escape --resume a.h5 --json --quiet",
     ""},
    {"escape-interrupted",
     unfinished("escape " + slow + " --per-trajectory", "INT"),
     {"a.h5"},
     "$carom escape --resume a.h5 --json --quiet --threads 1",
     "a.h5"},
    {"escape-checkpoint",
     unfinished("escape " + slow + " --per-trajectory", "KILL"),
     {"a.h5.part/checkpoint.h5", "a.h5.part/records"},
     "$carom escape --resume a.h5 --json --quiet --threads 1",
     "a.h5"},
    {"diffusion",
     "$carom diffusion lorentz-triangular --trajectories 50 --t-max 5 -o a.h5 --quiet",
     {"a.h5"},
     "$carom diffusion --resume a.h5 --json --quiet",
     ""},
    {"diffusion-checkpoint",
     unfinished("diffusion lorentz-triangular --trajectories 20000 --t-max 100 --block 50", "KILL"),
     {"a.h5.part/checkpoint.h5"},
     "$carom diffusion --resume a.h5 --json --quiet --threads 1",
     "a.h5"},
    {"merge",
     "for k in 1 2; do $carom escape stadium --trajectories 1000 --t-max 20 --per-trajectory "
     "--shard $k/2 -o s$k.h5 --quiet; done; mv s1.h5 a.h5",
     {"a.h5"},
     "$carom merge out.h5 a.h5 s2.h5 --json --quiet",
     "out.h5"},
};

// What a command prints, but for times.
std::string lasting(const std::string& json) {
  std::istringstream lines(json);
  std::string kept;
  for (std::string line; std::getline(lines, line);)
    if (line.find("seconds\"") == std::string::npos) kept += line + "\n";
  return kept;
}

// Reads as the program does.
void read_archive(const std::string& name, const std::string& path) {
  if (name.starts_with("run")) {
    read_run(path);
  } else if (name.starts_with("diffusion")) {
    read_ensemble<DiffusionResult>(path);
  } else if (name.starts_with("escape") || name == "merge") {
    read_ensemble<EscapeResult>(path);
  } else {  // of these the program reads nothing back
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) throw InputError(Place{path, 0, 0, ""}, "no archive");
    try {
      files::hdf5::verify(file, path);
    } catch (...) {
      H5Fclose(file);
      throw;
    }
    H5Fclose(file);
  }
}

using Counts = std::map<std::string, int>;
void print(const char* reader, const char* name, const Counts& counts) {
  std::cout << name << ", " << reader << ":";
  for (const auto& [outcome, count] : counts) std::cout << " " << count << " " << outcome;
  std::cout << std::endl;
}

void make(const Shell& shell, const Archive& archive) {
  shell(archive.make);
  for (const std::string& file : archive.damaged) ASSERT_TRUE(shell.exists(file)) << archive.name;
  ASSERT_EQ(shell("mkdir kept && cp -r a.h5* kept").status, 0);
}

class DamageFuzz : public testing::TestWithParam<Archive> {};

TEST_P(DamageFuzz, ReadersRefuseOrReadWhatWasWritten) {
  const Archive& archive = GetParam();
  const Shell shell;
  make(shell, archive);
  prepare_archives();
  Cases cases(1);
  const std::string file = archive.damaged.front(), path = shell.folder() + "/" + file,
                    bytes = read_file(path);
  const std::map<std::string, std::string> datasets = open_archive(path).datasets;
  ASSERT_FALSE(datasets.empty());
  Counts counts;
  for (int k = 0; k < by_readers; ++k) {
    const std::size_t way = cases.below(std::size(ways));
    const std::string bad = damaged(bytes, way, cases);
    write_file(path, bad);
    try {
      read_archive(archive.name, shell.folder() + "/a.h5");
    } catch (const InputError& error) {
      EXPECT_TRUE(error.place().file == path || error.place().file == path + ": /system")
          << error.what();
      EXPECT_TRUE(bad != bytes) << error.what();
      ++counts[std::string(ways[way]) + " refused"];
      continue;
    }
    ASSERT_TRUE(open_archive(path).datasets == datasets) << archive.name << " " << k;
    ++counts[std::string(ways[way]) + (bad == bytes ? " to the same" : " read")];
  }
  print("readers", archive.name, counts);
}

// A time limit is a guard against loops: nothing here takes a second.
TEST_P(DamageFuzz, TheProgramRefusesOrGivesTheSameResult) {
  const Archive& archive = GetParam();
  if (archive.use.empty()) GTEST_SKIP() << "nothing reads it";
  const Shell shell;
  make(shell, archive);
  const std::string use = "ulimit -t 60; " + archive.use,
                    path = shell.folder() + "/" + archive.result;
  const Outcome whole = shell(use);
  ASSERT_EQ(whole.status, 0) << whole.err;
  const auto datasets = [&] {
    return archive.result.empty() ? std::map<std::string, std::string>()
                                  : open_archive(path).datasets;
  };
  const std::map<std::string, std::string> expected = datasets();
  Cases cases(2);
  Counts counts;
  for (int k = 0; k < by_program; ++k) {
    ASSERT_EQ(shell("rm -rf out.h5 a.h5*; cp -r kept/* .").status, 0);
    const std::string& file = archive.damaged[cases.below(archive.damaged.size())];
    const std::size_t way = cases.below(std::size(ways));
    write_file(shell.folder() + "/" + file, damaged(shell.read(file), way, cases));
    const Outcome o = shell(use);
    if (o.status == 1) {
      EXPECT_EQ(o.out, "");
      EXPECT_NE(o.err.find(file), std::string::npos) << o.err;
      EXPECT_FALSE(shell.exists("out.h5"));
    } else {
      ASSERT_EQ(o.status, 0) << archive.name << " " << k << "\n" << o.err;
      ASSERT_EQ(lasting(o.out), lasting(whole.out)) << archive.name << " " << k;
      ASSERT_TRUE(datasets() == expected) << archive.name << " " << k;
    }
    ++counts[std::string(ways[way]) + (o.status == 1 ? " refused" : " without effect")];
  }
  print("program", archive.name, counts);
}

INSTANTIATE_TEST_SUITE_P(Archives, DamageFuzz, testing::ValuesIn(archives), [](const auto& about) {
  std::string name = about.param.name;
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace carom
