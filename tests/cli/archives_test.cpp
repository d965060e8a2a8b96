// Archives as the program leaves them: finished, interrupted, refused, on a full disk.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "archive_contents.hpp"
#include "program.hpp"

namespace carom {
namespace {

std::int64_t provenance_number(const std::string& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t number = H5Aopen_by_name(file, "provenance", name, H5P_DEFAULT, H5P_DEFAULT);
  std::int64_t value = -1;
  H5Aread(number, H5T_NATIVE_INT64, &value);
  H5Aclose(number);
  H5Fclose(file);
  return value;
}

TEST(Archives, TheyHoldTheSharesOfDecisions) {
  const Shell shell;
  // The run meets corners exactly: double precision cannot decide that.
  const std::string commands[] = {"escape magnetic-square --trajectories 100 --t-max 50",
                                  "diffusion sinai --trajectories 100 --t-max 10",
                                  "section stadium --points 50",
                                  "run magnetic-square --set field.B=0 --set table.hole=[] "
                                  "--position 1/4,1/4 --velocity 1,1 --t-max 3"};
  for (const std::string& command : commands) {
    const Outcome o = shell("$carom " + command + " -o a.h5 --force --json");
    ASSERT_EQ(o.status, 0) << o.err;
    const std::string counts = json_value(o.out, "decisions");
    const std::string path = shell.folder() + "/a.h5";
    const std::string expected =
        "\"filter\": " + std::to_string(provenance_number(path, "decisions_filter")) +
        ", \"exact\": " + std::to_string(provenance_number(path, "decisions_exact"));
    EXPECT_NE(counts.find(expected), std::string::npos) << command << counts << expected;
    EXPECT_GT(provenance_number(
                  path, command.starts_with("run") ? "decisions_exact" : "decisions_filter"),
              0);
  }
  // A run that goes on adds to them.
  const std::string part = "$carom run sinai --t-max ";
  shell(part + "20 -o whole.h5; " + part + "10 -o part.h5; $carom run --resume part.h5 --t-max 20");
  const auto whole = provenance_number(shell.folder() + "/whole.h5", "decisions_filter");
  const auto both = provenance_number(shell.folder() + "/part.h5", "decisions_filter");
  EXPECT_GE(both, whole);
  EXPECT_LE(both, whole + 4);  // the flight under way is looked at again
}

TEST(RunArchive, HoldsEveryHitDescribed) {
  const Shell shell;
  const Outcome o = shell("$carom run sinai --collisions 5000 --set run.sample=10 -o a.h5 --json");
  EXPECT_EQ(o.status, 0) << o.err;
  const Contents a = open_archive(shell.folder() + "/a.h5");
  EXPECT_EQ(a.complete, 1);
  EXPECT_EQ(a.status, "completed");
  EXPECT_TRUE(a.undescribed.empty()) << a.undescribed.front();
  EXPECT_EQ(a.datasets.at("collisions/t").size(), 5000 * sizeof(double));
  EXPECT_GT(a.datasets.at("trajectory/t").size(), 100 * sizeof(double));
  EXPECT_NE(a.datasets.at("system").find("[table]"), std::string::npos);
}

TEST(RunArchive, IsTheSameWithAndWithoutSamples) {
  const Shell shell;
  shell(
      "$carom run mushroom --t-max 500 --set field.B=0.2 -o a.h5; "
      "$carom run mushroom --t-max 500 --set field.B=0.2 --set run.sample=0.7 -o b.h5");
  const Contents a = open_archive(shell.folder() + "/a.h5"),
                 b = open_archive(shell.folder() + "/b.h5");
  EXPECT_FALSE(a.datasets.empty());
  for (const auto& [name, bytes] : a.datasets) {
    if (name.rfind("collisions/", 0) == 0 || name.rfind("state/", 0) == 0) {
      EXPECT_EQ(bytes, b.datasets.at(name)) << name;
    }
  }
}

TEST(RunArchive, SystemCanBeRunAgain) {
  const Shell shell;
  shell("$carom run ellipse-magnetic --t-max 80 --seed 7 -o a.h5");
  const std::string text = open_archive(shell.folder() + "/a.h5").datasets.at("system");
  shell("cat > again.toml << 'END'\n" + text + "\nEND\n$carom run again.toml -o b.h5");
  EXPECT_EQ(open_archive(shell.folder() + "/a.h5").datasets,
            open_archive(shell.folder() + "/b.h5").datasets);
}

TEST(RunArchive, GoesOnAsIfNeverStopped) {
  const Shell shell;
  for (const char* system :
       {"lorentz-triangular", "ellipse-magnetic --set particles.count=2", "stadium"}) {
    const Outcome o =
        shell(std::string("run=\"$carom run ") + system +
              " --set run.sample=0.37 --set run.times=[1,2] --force\"\n"
              "$run --t-max 200 -o whole.h5 && $run --t-max 31 -o part.h5 &&"
              "$carom run --resume part.h5 --t-max 100 && $carom run --resume part.h5 --t-max 200");
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_EQ(open_archive(shell.folder() + "/whole.h5").datasets,
              open_archive(shell.folder() + "/part.h5").datasets)
        << system;
    EXPECT_FALSE(shell.exists("part.h5.part"));
  }
  const Outcome back =
      shell("$carom run sinai --t-max 50 -o sinai.h5 && $carom run --resume sinai.h5 --t-max 20");
  EXPECT_EQ(back.status, 1);
  EXPECT_NE(back.err.find("--t-max: "), std::string::npos) << back.err;
}

// Each particle is stopped at its own third hit. Flown on from there they would act on each other
// at times that are not the same.
TEST(RunArchive, DoesNotReviveParticlesThatStoppedAtOtherTimes) {
  const Shell shell;
  const std::string pair = "$carom run stadium --closed --set particles.count=2 --collisions 3 ";
  for (const std::string acting :
       {"--set 'interaction={kind=\"coulomb\",strength=0.3}' --set integrator.step=0.01 ",
        "--set 'interaction={kind=\"hard-discs\",radius=0.05}' --set "
        "'initial={kind=\"uniform\"}' "}) {
    EXPECT_EQ(shell(pair + acting + "--force -o a.h5").status, 0);
    expect_refused(shell("$carom run --resume a.h5 --collisions 8"),
                   "command line: --collisions: ");
    EXPECT_EQ(shell("$carom run --resume a.h5").status, 0) << acting;
  }
  EXPECT_EQ(shell(pair + "--force -o a.h5 && $carom run --resume a.h5 --collisions 8").status, 0);
}

// Afterwards the archive is that of an uninterrupted run: it is of one system.
TEST(RunArchive, GoesOnWithNothingButTheSameRun) {
  const Shell shell;
  shell("$carom run henon-heiles --t-max 5 -o a.h5; $carom run stadium --t-max 2 -o b.h5");
  const std::pair<const char*, const char*> others[] = {
      {"a.h5 --set integrator.step=0.05", "integrator.step is 0.05, not 0.1"},
      {"a.h5 --position 0,0 --velocity 1,0", "initial.position"},
      {"a.h5 --seed 2", "run.seed is 2, not 1"},
      {"a.h5 --trajectory 3", "--trajectory is 3, not 0"},
      {"b.h5 --engine steps --set integrator.step=0.1", "integrator"}};
  for (const auto& [options, what] : others) {
    const Outcome o = shell(std::string("$carom run --t-max 9 --resume ") + options);
    expect_refused(o, std::string(options).substr(0, 4) + ": ");
    EXPECT_NE(o.err.find(what), std::string::npos) << o.err;
  }
  const Outcome same =
      shell("$carom run --t-max 9 --resume a.h5 --seed 1 --trajectory 0 --set run.sample=1");
  EXPECT_EQ(same.status, 0) << same.err;
}

TEST(RunArchive, SaysThatThereIsNothingToGoOnWith) {
  const Shell shell;
  shell("$carom run stadium --collisions 1000 -o gone.h5");
  const Outcome more = shell("$carom run --resume gone.h5 --collisions 2000 --json");
  EXPECT_EQ(more.status, 0);
  EXPECT_EQ(json_value(more.out, "status"), "\"escaped\"");
  EXPECT_NE(more.err, "");
  shell("$carom run sinai --collisions 100 -o here.h5");
  EXPECT_EQ(shell("$carom run --resume here.h5 --collisions 200 --json").err, "");
}

TEST(RunArchive, SurvivesCtrlC) {
  const Shell shell;
  const Outcome o = shell(
      "$carom run sinai --collisions 1e12 -o a.h5 --json & pid=$!; until_there a.h5; sleep 1; "
      "kill -INT $pid; wait $pid");
  EXPECT_EQ(o.status, 130);
  EXPECT_EQ(json_value(o.out, "status"), "\"interrupted\"");
  const Contents a = open_archive(shell.folder() + "/a.h5");
  EXPECT_EQ(a.status, "interrupted");
  EXPECT_EQ(std::to_string(a.datasets.at("collisions/t").size() / sizeof(double)),
            json_value(o.out, "collisions"));
  // What was interrupted goes on.
  const std::string more =
      std::to_string(a.datasets.at("collisions/t").size() / sizeof(double) + 1000);
  EXPECT_EQ(json_value(shell("$carom run --resume a.h5 --collisions " + more + " --json").out,
                       "collisions"),
            more);
}

// The last rows of all columns of /collisions, at most three batches of them; -1 where a column
// cannot be read. They are of one length but while the writer is between two of them.
long read_last_rows(hid_t file) {
  long least = -1;
  for (const char* name : {"particle", "wall", "s", "v_parallel", "t", "x", "y", "vx", "vy",
                           "cell_first", "cell_second", "reflections"}) {
    const hid_t column = H5Dopen2(file, (std::string("collisions/") + name).c_str(), H5P_DEFAULT);
    H5Drefresh(column);
    const hid_t space = H5Dget_space(column);
    const hssize_t rows = H5Sget_simple_extent_npoints(space);
    const hsize_t count = std::min<hsize_t>(static_cast<hsize_t>(rows), 3 * 4096),
                  start = static_cast<hsize_t>(rows) - count;
    const hid_t memory = H5Screate_simple(1, &count, nullptr);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &count, nullptr);
    std::vector<double> values(count);
    const bool read =
        H5Dread(column, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(column);
    if (!read) return -1;
    least = least < 0 ? rows : std::min<long>(least, rows);
  }
  return least;
}

TEST(RunArchive, CanBeReadWhileItGrowsAndAfterAKill) {
  const Shell shell;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  shell(
      "$carom run sinai --collisions 1e12 -o a.h5 --quiet --json & pid=$!; echo $pid > pid; "
      "until [ $(stat -c %s a.h5) -gt 2000000 ]; do kill -0 $pid || break; sleep 0.01; done");
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  const hid_t file =
      H5Fopen((shell.folder() + "/a.h5").c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
  EXPECT_GE(file, 0);
  long before = 0;
  for (int i = 0; i < 20; ++i) {
    const long rows = read_last_rows(file);
    EXPECT_GE(rows, std::max(before, 4096L)) << i;
    before = rows;
  }
  H5Fclose(file);
  // Where nothing waits for orphans it stays as a zombie, which holds no file.
  shell(
      "kill -9 $(cat pid); while grep -qs '^State:.[^ZX]' /proc/$(cat pid)/status; do sleep 0.01; "
      "done");
  const hid_t killed =
      H5Fopen((shell.folder() + "/a.h5").c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
  EXPECT_GE(read_last_rows(killed), before);
  EXPECT_EQ(read_last_rows(killed) % 4096, 0);
  H5Fclose(killed);
  H5Pclose(access);
  const Outcome resumed = shell("$carom run --resume a.h5 --t-max 1e9");
  expect_refused(resumed, "a.h5: ");
}

// HDF5 locks what it opens, for reading, too.
TEST(RunArchive, SaysThatAnotherProgramHasItOpen) {
  const Shell shell;
  ASSERT_EQ(shell("$carom run stadium --t-max 3 -o a.h5 --quiet").status, 0);
  const std::map<std::string, std::string> datasets =
      open_archive(shell.folder() + "/a.h5").datasets;
  const hid_t reader = H5Fopen((shell.folder() + "/a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(reader, 0);
  const Outcome o = shell("$carom run stadium --t-max 3 -o a.h5 --quiet --force");
  expect_refused(o, "a.h5: ");
  H5Fclose(reader);
  EXPECT_EQ(open_archive(shell.folder() + "/a.h5").datasets, datasets);
  EXPECT_EQ(shell("$carom run stadium --t-max 3 -o a.h5 --quiet --force").status, 0);
}

TEST(EscapeArchive, HoldsEveryTrajectory) {
  const Shell shell;
  const Outcome o = shell(
      "$carom escape mushroom --trajectories 3000 --t-max 50 --per-trajectory -o a.h5 --threads 1 "
      "&& $carom escape mushroom --trajectories 3000 --t-max 50 --per-trajectory -o b.h5 --threads "
      "2");
  EXPECT_EQ(o.status, 0) << o.err;
  const Contents a = open_archive(shell.folder() + "/a.h5");
  EXPECT_TRUE(a.undescribed.empty()) << a.undescribed.front();
  EXPECT_EQ(a.complete, 1);
  EXPECT_EQ(a.datasets.at("trajectories/index").size(), 3000 * sizeof(std::uint64_t));
  EXPECT_EQ(a.datasets.count("survival/p"), 1u);
  EXPECT_EQ(a.datasets, open_archive(shell.folder() + "/b.h5").datasets);
  EXPECT_EQ(shell.files().size(), 2u) << "a .part was left";
}

// One column of a group of an archive.
template <class T>
std::vector<T> numbers(const Contents& contents, const std::string& name) {
  const std::string& bytes = contents.datasets.at(name);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::vector<std::string> names_of(const std::string& path, const char* dataset) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              at = H5Dopen2(file, dataset, H5P_DEFAULT);
  const std::string texts = read_attribute(at, "names");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < texts.size(); i += names.back().size() + 1)
    names.emplace_back(texts.c_str() + i);
  H5Dclose(at), H5Fclose(file);
  return names;
}

// Across the parameter 0 of a circle a hole is stored in two pieces, which do not show.
TEST(EscapeArchive, AHoleInTwoPiecesIsOne) {
  const Shell shell;
  const std::string run = "$carom escape one.toml --per-trajectory --json --quiet ";
  const Outcome o = shell(
      "cat > one.toml <<'END'\n[table]\nshape = \"circle\"\nradius = 1\n[[table.hole]]\nwall = "
      "\"circle\"\ncenter = 3\nwidth = 0.4\n"
      "[[table.hole]]\nwall = \"circle\"\ncenter = 0\nwidth = 0.6\n[initial]\nkind = "
      "\"uniform\"\n[run]\nt_max = 60\ntrajectories = 900\nEND\n" +
      run + "-o a.h5");
  ASSERT_EQ(o.status, 0) << o.err;
  const std::vector<std::string> both{"hole_1", "hole_2"};
  EXPECT_EQ(names_of(shell.folder() + "/a.h5", "fates/holes"), both);
  EXPECT_EQ(names_of(shell.folder() + "/a.h5", "trajectories/hole"), both);
  const Contents a = open_archive(shell.folder() + "/a.h5");
  std::vector<std::uint64_t> by_hole(2, 0);
  for (const std::int32_t hole : numbers<std::int32_t>(a, "trajectories/hole"))
    if (hole >= 0) ++by_hole.at(static_cast<std::size_t>(hole));
  EXPECT_EQ(numbers<std::uint64_t>(a, "fates/holes"), by_hole);
  EXPECT_GT(by_hole[0], 10u);
  EXPECT_GT(by_hole[1], by_hole[0]);
  for (const std::uint64_t n : by_hole)
    EXPECT_NE(json_value(o.out, "holes").find("\"escaped\": " + std::to_string(n)),
              std::string::npos)
        << json_value(o.out, "holes");
  // One by one, in parts and continued: the same.
  const Outcome parts = shell(run +
                              "--isa baseline --shard 1/2 -o 1.h5 && $carom merge half.h5 1.h5 && "
                              "$carom escape --resume half.h5");
  EXPECT_EQ(parts.status, 0) << parts.err;
  expect_same_datasets(shell.folder() + "/half.h5", a.datasets);
}

TEST(EscapeArchive, RowsAreTheTrajectoriesThatWereCounted) {
  const Shell shell;
  const Outcome o = shell(
      "$carom escape mushroom --trajectories 2000 --t-max 60 --per-trajectory -o a.h5 --json "
      "--set "
      "'table.hole=[{wall=\"stem_bottom\",center=0.5,width=0.2},{wall=\"cap\",center=1,width=0.1}]"
      "'");
  ASSERT_EQ(o.status, 0) << o.err;
  const Contents a = open_archive(shell.folder() + "/a.h5");
  const auto fate = numbers<std::int32_t>(a, "trajectories/fate"),
             hole = numbers<std::int32_t>(a, "trajectories/hole");
  const auto hits = numbers<std::uint64_t>(a, "trajectories/hits");
  const auto t = numbers<double>(a, "trajectories/t"), x = numbers<double>(a, "trajectories/x"),
             y = numbers<double>(a, "trajectories/y"), vx = numbers<double>(a, "trajectories/vx"),
             vy = numbers<double>(a, "trajectories/vy");
  ASSERT_EQ(fate.size(), 2000u);
  std::uint64_t escaped = 0, collisions = 0, by_hole[2] = {0, 0};
  for (std::size_t i = 0; i < fate.size(); ++i) {
    collisions += hits[i];
    EXPECT_NEAR(vx[i] * vx[i] + vy[i] * vy[i], 1.0, 1e-14);
    EXPECT_EQ(hole[i] >= 0, t[i] < 60.0);
    if (hole[i] < 0) continue;
    ++escaped;
    ++by_hole[hole[i]];
  }
  EXPECT_EQ(std::to_string(escaped), json_value(o.out, "escaped"));
  EXPECT_EQ(std::to_string(collisions), json_value(o.out, "collisions"));
  EXPECT_EQ(numbers<std::uint64_t>(a, "fates/holes"),
            (std::vector<std::uint64_t>{by_hole[0], by_hole[1]}));
  // The starts are those of single runs.
  for (std::size_t i = 0; i < 3; ++i) {
    const Outcome one =
        shell("$carom run mushroom --trajectory " + std::to_string(i) + " --t-max 0.001 --json");
    EXPECT_NEAR(std::stod(json_value(one.out, "x")), x[i] + 0.001 * vx[i], 1e-12);
    EXPECT_NEAR(std::stod(json_value(one.out, "y")), y[i] + 0.001 * vy[i], 1e-12);
  }
  // By hits: the particles that had not escaped within n.
  const auto n = numbers<std::uint64_t>(a, "survival_hits/n");
  const auto p = numbers<double>(a, "survival_hits/p");
  for (std::size_t k = 0; k < n.size(); ++k) {
    std::uint64_t there = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) there += hole[i] < 0 || hits[i] > n[k];
    EXPECT_DOUBLE_EQ(p[k], static_cast<double>(there) / 2000.0) << n[k];
  }
}

TEST(EscapeArchive, SurvivesCtrlC) {
  const Shell shell;
  const Outcome o = shell(
      "$carom escape sinai --trajectories 1e12 --per-trajectory -o a.h5 --json --checkpoint "
      "blocks:1 & pid=$!; "
      "until_saved a.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(o.status, 130);
  EXPECT_TRUE(is_json_object(o.out));
  const Contents a = open_archive(shell.folder() + "/a.h5");
  EXPECT_EQ(a.status, "interrupted");
  EXPECT_EQ(a.complete, 0);
  EXPECT_EQ(std::to_string(a.datasets.at("trajectories/index").size() / sizeof(std::uint64_t)),
            json_value(o.out, "trajectories"));
  EXPECT_EQ(shell.files().size(), 1u);
}

TEST(Output, AnExistingOutputIsKept) {
  const Shell shell;
  for (const char* command :
       {"$carom escape sinai --trajectories 10 -o a.h5", "$carom run sinai --t-max 5 -o a.h5"}) {
    const Outcome refused = shell(std::string("echo mine > a.h5; ") + command);
    EXPECT_EQ(refused.status, 1);
    EXPECT_EQ(refused.out, "");
    EXPECT_NE(refused.err.find("--force"), std::string::npos);
    EXPECT_EQ(shell.read("a.h5"), "mine\n");
    EXPECT_EQ(shell(std::string(command) + " --force").status, 0);
    EXPECT_EQ(open_archive(shell.folder() + "/a.h5").complete, 1);
  }
  shell("echo mine > a.h5");
  EXPECT_EQ(shell("$carom run circle --position 5,0 --velocity 1,0 -o a.h5 --force").status, 1);
  EXPECT_EQ(shell.read("a.h5"), "mine\n") << "bad input must not cost a file";
}

TEST(FullDisk, LeavesNothing) {
  const Shell shell;
  // In blocks of 512 bytes (sh) or 1024 (bash): before the head, within the data.
  for (const char* size : {"2", "64", "300"}) {
    for (const char* command :
         {"$carom run sinai --collisions 1e6 -o a.h5",
          "$carom escape sinai --trajectories 20000 --t-max 5 --per-trajectory -o a.h5",
          "$carom section stadium --closed --orbits 400 --points 1000 --threads 4 -o a.h5"}) {
      const Outcome o = shell("( ulimit -f " + std::string(size) + "; " + command + " --json )");
      EXPECT_EQ(o.status, 1) << command;
      EXPECT_EQ(o.out, "");
      EXPECT_EQ(o.err, "carom: cannot write 'a.h5': File too large\n");
      EXPECT_TRUE(shell.files().empty()) << command;
    }
  }
}

TEST(FullDisk, KeepsTheRunThatWasToGoOn) {
  const Shell shell;
  EXPECT_EQ(shell("$carom run sinai --collisions 1000 -o a.h5").status, 0);
  const std::string before = shell.read("a.h5");
  const Outcome o = shell("( ulimit -f 600; $carom run --resume a.h5 --collisions 1e6 )");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(shell.read("a.h5"), before);
  EXPECT_EQ(shell.files().size(), 1u);
}

// Readers get numbers, not lists of one, and no texts of digits.
TEST(Archives, SingleNumbersAreScalars) {
  const Shell shell;
  ASSERT_EQ(
      shell("$carom escape stadium --trajectories 50 --t-max 9 --seed 7 -o e.h5 && "
            "$carom diffusion lorentz-triangular --trajectories 50 --t-max 9 --seed 7 -o d.h5 "
            "&& $carom section stadium --closed --points 5 --seed 7 -o s.h5 && $carom run "
            "siam-photon --precision certified --digits 5 --t-max 3 --seed 7 -o c.h5")
          .status,
      0);
  const std::pair<const char*, const char*> numbers[] = {{"e.h5", "fates/escaped"},
                                                         {"e.h5", "fates/digest"},
                                                         {"d.h5", "fates/survived"},
                                                         {"s.h5", "fates/points"},
                                                         {"c.h5", "state/x"}};
  for (const auto& [name, path] : numbers) {
    const hid_t file = H5Fopen((shell.folder() + "/" + name).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file, 0) << name;
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(dataset);
    EXPECT_EQ(H5Sget_simple_extent_type(space), H5S_SCALAR) << name << path;
    H5Sclose(space);
    H5Dclose(dataset);
    const hid_t seed = H5Aopen_by_name(file, "provenance", "seed", H5P_DEFAULT, H5P_DEFAULT),
                type = H5Aget_type(seed);
    std::uint64_t value = 0;
    EXPECT_EQ(H5Tget_class(type), H5T_INTEGER) << name;
    EXPECT_GE(H5Aread(seed, H5T_NATIVE_UINT64, &value), 0);
    EXPECT_EQ(value, 7u);
    H5Tclose(type);
    H5Aclose(seed);
    H5Fclose(file);
  }
}

}  // namespace
}  // namespace carom
