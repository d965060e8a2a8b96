// --sweep: rows equal the runs that it stands for, bad values are named before anything is
// computed, and what was computed survives.
#include <gtest/gtest.h>

#include "archive_contents.hpp"
#include "program.hpp"

namespace carom {
namespace {

const std::string escape = "$carom escape magnetic-square --trajectories 3000 --quiet ";
const std::string sweep = "--sweep field.B=lin:0.5:1.5:3 ";

// The rows of a sweep, as text.
std::vector<std::string> rows_of(const std::string& json) {
  std::vector<std::string> rows;
  for (std::size_t at = json.find("{\"values\": "); at != std::string::npos;) {
    const std::size_t next = json.find("{\"values\": ", at + 1);
    rows.push_back(json.substr(at, next - at));
    at = next;
  }
  return rows;
}
std::string digest_in(const std::string& text) {
  const std::size_t at = text.find("\"digest\": \"");
  return at == std::string::npos ? "" : text.substr(at + 11, 16);
}
std::vector<std::string> digests_of(const std::string& json) {
  std::vector<std::string> digests;
  for (const std::string& row : rows_of(json)) digests.push_back(digest_in(row));
  return digests;
}

// Any reader of HDF5 finds in it what the run of a value alone would have stored.
TEST(Sweep, ValuesAreGroupsAsTheirArchives) {
  const Shell shell;
  ASSERT_EQ(shell(escape + sweep + "-o sweep.h5").status, 0);
  ASSERT_EQ(shell(escape + "--set field.B=1 -o one.h5").status, 0);
  const Contents all = open_archive(shell.folder() + "/sweep.h5");
  const Contents one = open_archive(shell.folder() + "/one.h5");
  std::size_t found = 0;
  for (const auto& [path, bytes] : one.datasets) {
    const auto same = all.datasets.find("values/1/" + path);
    ASSERT_NE(same, all.datasets.end()) << path;
    if (path != "system") {
      EXPECT_EQ(same->second, bytes) << path;
    }
    ++found;
  }
  EXPECT_GT(found, 30u);
}

TEST(Sweep, RowsAreTheRunsOfTheirValues) {
  const Shell shell;
  for (const std::string& command : std::vector<std::string>{
           escape, std::string("$carom diffusion lorentz-triangular --trajectories 200 --t-max 20 "
                               "--set table.radius=0.4 --quiet ")}) {
    const Outcome all = shell(command + "--sweep field.B=list:1/3,0.5 --json");
    ASSERT_EQ(all.status, 0) << all.err;
    EXPECT_TRUE(is_json_object(all.out));
    const std::vector<std::string> digests = digests_of(all.out);
    ASSERT_EQ(digests.size(), 2u) << all.out;
    EXPECT_NE(digests[0], digests[1]);
    EXPECT_EQ(digests[0], digest_in(shell(command + "--set 'field.B=1/3' --json").out));
    EXPECT_EQ(digests[1], digest_in(shell(command + "--set field.B=0.5 --json").out));
  }
}

TEST(Sweep, OfTwoKeysIsAPlane) {
  const Shell shell;
  const Outcome o = shell(escape + sweep + "--sweep run.seed=list:1,2 --json");
  ASSERT_EQ(o.status, 0) << o.err;
  const std::vector<std::string> rows = rows_of(o.out);
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_NE(rows[1].find("{\"values\": {\"field.B\": 0.5, \"run.seed\": 2}"), std::string::npos);
  EXPECT_NE(rows[2].find("{\"values\": {\"field.B\": 1, \"run.seed\": 1}"), std::string::npos);
}

TEST(Sweep, GivesEveryCommandARowAValue) {
  const Shell shell;
  for (const char* command :
       {"run stadium --closed --collisions 20 --sweep table.half_length=list:1,2",
        "section stadium --closed --orbits 2 --points 20 --sweep table.half_length=list:1,2",
        "run stadium --closed --precision certified --collisions 5 --sweep "
        "table.half_length=list:1,2",
        "escape three-disc --splitting 2,4 --population 200 --repetitions 2 --sweep "
        "table.radius=list:1,0.9",
        "diffusion lorentz-triangular --trajectories 50 --t-max 9 --sweep "
        "table.spacing=list:2.1,2.2",
        "lyapunov stadium --closed --trajectories 9 --t-max 20 --sweep table.half_length=list:1,2",
        "relax wigner --starts 5 --sweep particles.count=list:2,3",
        "orbit three-disc --hits 3 --zeta --sweep table.radius=list:1,0.9",
        "compare henon-heiles --schemes velocity-verlet --steps 0.2,0.1 --t-max 2 --sweep "
        "particles.energy=list:0.05,0.1"}) {
    const Outcome o = shell(std::string("$carom ") + command + " --json --quiet");
    EXPECT_EQ(o.status, 0) << command << o.err;
    EXPECT_EQ(rows_of(o.out).size(), 2u) << command;
    const Outcome text = shell(std::string("$carom ") + command + " --quiet");
    EXPECT_EQ(text.status, 0) << command << text.err;
  }
}

TEST(Sweep, SaysWhyValuesHaveNoResult) {
  const Shell shell;
  const std::string swept = "$carom lyapunov stadium --trajectories 20 --quiet --sweep run.t_max=";
  const Outcome o = shell(swept + "list:20,2000,3000");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NE(on_one_line(o.out).find("run.t_max = 2000: all 20 particles ended before"),
            std::string::npos)
      << o.out;
  // Where no value has one, it ends as each of them alone does, and leaves no archive.
  for (const char* archive : {"", " -o a.h5"}) {
    const Outcome none = shell(swept + "list:2000,3000" + archive);
    expect_refused(none, "command line: --sweep");
    EXPECT_NE(none.err.find("run.t_max = 2000: all 20 particles ended"), std::string::npos)
        << none.err;
    EXPECT_TRUE(shell.files().empty());
  }
}

TEST(Sweep, SaysOfEachValueOnlyWhatIsTheSame) {
  const Shell shell;
  const std::string run = "$carom escape stadium --t-max 5 --quiet ";
  const std::string few = "--trajectories 20 ", radii = "--sweep table.radius=list:1,2";
  const Outcome all = shell(run + few + radii),
                seeds = shell(run + few + "--sweep run.seed=list:1,2"),
                sizes = shell(run + "--sweep run.trajectories=list:20,30");
  const auto says = [](const Outcome& o, const char* what) {
    return on_one_line(o.out).find(what) != std::string::npos;
  };
  EXPECT_TRUE(says(all, "from 1 to 2, 20 trajectories each, seed 1 for each")) << all.out;
  EXPECT_TRUE(says(seeds, "from 1 to 2, 20 trajectories each  ")) << seeds.out;
  EXPECT_TRUE(says(sizes, "from 20 to 30, seed 1 for each")) << sizes.out;
  EXPECT_EQ(json_value(shell(run + few + radii + " --json").out, "seed"), "1");
  EXPECT_EQ(json_value(shell(run + few + "--sweep run.seed=list:1,2 --json").out, "seed"), "null");
}

TEST(Sweep, NamesWhatIsBadBeforeItComputes) {
  const Shell shell;
  const std::pair<const char*, const char*> bad[] = {
      {"--sweep field.larmor_radius=lin:1:0:3", "command line: field.larmor_radius"},
      {"--sweep field.C=lin:0:1:3", "command line: field.C"},
      {"--sweep feld.B=lin:0:1:3", "command line: feld"},
      {"--sweep table.shape=lin:0:1:3", "command line: table.shape"},
      {"--sweep table.shape=list:circle,stadium", "command line: --sweep table.shape"},
      {"--sweep field.B", "command line: --sweep"},
      {"--sweep section.points=list:1,2", "command line: --sweep section.points"},
      {"--sweep run.sample=list:1,2", "command line: --sweep run.sample"},
      {"--sweep integrator.step=list:1,2", "command line: --sweep integrator.step"},
      {"--sweep run.seed=list:1,2 --seed 3", "command line: --sweep run.seed"},
      {"--sweep field.B=list:1,2 --set field.B=1", "command line: --sweep field.B"},
      {"--sweep field.B=list:1,2 --sweep field.B=list:3,4", "command line: --sweep field.B"},
  };
  for (const auto& [words, place] : bad) {
    expect_refused(shell(escape + words + " -o a.h5"), place);
    EXPECT_TRUE(shell.files().empty()) << words;
  }
}

TEST(Sweep, IsOneArchive) {
  const Shell shell;
  const Outcome made = shell(escape + sweep + "-o a.h5 --json");
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(shell.files(), std::vector<std::string>{"a.h5"});
  const Outcome shown = shell("$carom escape --resume a.h5 --json");
  EXPECT_EQ(rows_of(shown.out), rows_of(made.out)) << shown.err;
  EXPECT_EQ(shell(escape + sweep + "-o a.h5").status, 1) << "it exists";
  // Another window asks for other fits, and computes nothing.
  const Outcome other = shell("$carom escape --resume a.h5 --window 2:50 --json");
  EXPECT_EQ(digests_of(other.out), digests_of(made.out)) << other.err;
  EXPECT_NE(rows_of(other.out), rows_of(made.out));
  EXPECT_EQ(shell("$carom diffusion --resume a.h5").status, 1) << "another command";
  EXPECT_EQ(shell("$carom escape magnetic-square --sweep field.B=lin:0:1:3 --resume a.h5").status,
            1);
}

// Killed in the middle, a sweep goes on with what it has, and ends with the same rows.
TEST(Sweep, GoesOnAfterAKill) {
  const Shell shell;
  const std::string command =
      "$carom escape magnetic-square --quiet --json --trajectories 200000 "
      "--sweep field.B=lin:0.5:1.5:5 ";
  const std::vector<std::string> whole = digests_of(shell(command).out);
  ASSERT_EQ(whole.size(), 5u);
  shell(command +
        "--checkpoint blocks:1 -o a.h5 & pid=$!; until_there a.h5.part/value-2; "
        "kill -9 $pid; wait $pid");
  EXPECT_EQ(shell(command + "-o a.h5").status, 1) << "there is one to go on with";
  const Outcome rest = shell("$carom escape --resume a.h5 --json");
  EXPECT_EQ(digests_of(rest.out), whole) << rest.err;
  EXPECT_EQ(shell.files(), std::vector<std::string>{"a.h5"});
}

TEST(Sweep, GoesOnAfterAnInterrupt) {
  const Shell shell;
  const std::string command =
      "$carom escape magnetic-square --quiet --json --trajectories 200000 "
      "--sweep field.B=lin:0.5:1.5:5 ";
  const std::vector<std::string> whole = digests_of(shell(command).out);
  const Outcome cut = shell(command +
                            "-o a.h5 & pid=$!; until_there a.h5.part/value-1; "
                            "kill $pid; wait $pid");
  EXPECT_EQ(cut.status, 130);
  EXPECT_EQ(shell.files(), std::vector<std::string>{"a.h5"});
  EXPECT_LT(rows_of(cut.out).size(), 5u);
  const Outcome rest = shell("$carom escape --resume a.h5 --json");
  EXPECT_EQ(digests_of(rest.out), whole) << rest.err;
}

TEST(Sweep, OfRunsGoesOnValueAfterValue) {
  const Shell shell;
  const std::string command =
      "$carom run stadium --closed --quiet --json --collisions 300000 "
      "--sweep table.half_length=lin:1:2:5 ";
  shell(command + "-o a.h5 & pid=$!; until_there a.h5.part/value-2; kill -9 $pid; wait $pid");
  const Outcome rest = shell("$carom run --resume a.h5 --json");
  EXPECT_EQ(rest.status, 0) << rest.err;
  EXPECT_EQ(rows_of(rest.out).size(), 5u);
  EXPECT_EQ(shell.files(), std::vector<std::string>{"a.h5"});
}

// Whatever --resume reads, an edited, exchanged or damaged file is named, and stays as it is.
TEST(Sweep, ChecksWhatItGoesOnWith) {
  const Shell shell;
  const std::string part = "a.h5.part/";
  const auto refused = [&](const std::string& command, const std::string& damage,
                           const std::string& named) {
    shell("rm -rf a.h5*; cp -r kept a.h5.part; cd a.h5.part; " + damage);
    const Outcome o = shell("$carom " + command + " --resume a.h5");
    EXPECT_EQ(o.status, 1) << damage;
    EXPECT_EQ(o.out, "") << damage;
    EXPECT_NE(o.err.find("carom: " + part + named), std::string::npos) << damage << "\n" << o.err;
    EXPECT_TRUE(shell.exists(part + "sweep")) << damage;
  };
  shell(
      "$carom escape magnetic-square --quiet --trajectories 200000 --sweep "
      "field.B=list:0.5,2,1,1.5,1.25 --checkpoint blocks:1 -o a.h5 & pid=$!; "
      "until_there a.h5.part/value-2; kill -9 $pid; wait $pid; mv a.h5.part kept");
  refused("escape", "sed -i 's/B = 2/B = 9/' sweep", "sweep: '/values/1/system' was changed");
  refused("escape", "truncate -s 1000 sweep", "sweep: ");
  refused("escape", ": > sweep", "sweep: ");
  refused("escape", "sed -i 's/completed/Completed/' value-0", "value-0: '/@status' was changed");
  refused("escape", "mv value-0 value-1", "value-1: it is not value 2 of the sweep");
  refused("escape", "printf '\\377' | dd of=value-0 bs=1 seek=20000 conv=notrunc", "value-0: ");
  shell("rm -rf a.h5*; cp -r kept a.h5.part");
  EXPECT_EQ(shell("$carom escape --resume a.h5").status, 0);

  shell(
      "rm -rf a.h5* kept; $carom run stadium --closed --quiet --collisions 300000 --sweep "
      "table.half_length=lin:1:2:5 -o a.h5 & pid=$!; "
      "until_there a.h5.part/value-2; kill -9 $pid; wait $pid; mv a.h5.part kept");
  refused("run", "printf '\\377' | dd of=value-1 bs=1 seek=20000 conv=notrunc", "value-1: ");
  refused("run", "cp value-0 value-1", "value-1: it is not value 2 of the sweep");
  refused("run", "sed -i 's/completed/Completed/' value-1", "value-1: '/@status' was changed");
  // A value that is missing is computed anew.
  shell("rm -rf a.h5*; cp -r kept a.h5.part; rm a.h5.part/value-0");
  EXPECT_EQ(rows_of(shell("$carom run --resume a.h5 --json").out).size(), 5u);
}

// A value is opened, shown with another window, and merged by its name in the file of the sweep.
TEST(Sweep, ValuesAreArchivesByTheirNames) {
  const Shell shell;
  ASSERT_EQ(shell(escape + sweep + "-o a.h5").status, 0);
  const Outcome shown = shell("$carom escape --resume a.h5/values/1 --json");
  EXPECT_EQ(digest_in(shown.out), digest_in(shell(escape + "--set field.B=1 --json").out))
      << shown.err;
  EXPECT_EQ(shell("$carom escape --resume a.h5/values/7").status, 1);
}

// What a run alone warns of stands in each row, and in the text.
TEST(Sweep, KeepsTheDoubtsOfSplitting) {
  const Shell shell;
  const std::string command =
      "$carom escape three-disc --splitting 1,2 --population 20 --repetitions 2 --quiet ";
  const char* const doubt = "populations of 20 trajectories: errors and intervals need at least";
  const Outcome alone = shell(command + "--json");
  EXPECT_NE(alone.err.find(doubt), std::string::npos) << alone.err;
  EXPECT_NE(json_value(alone.out, "note").find(doubt), std::string::npos) << alone.out;
  const Outcome swept = shell(command + "--sweep run.seed=list:1,2 --json");
  EXPECT_EQ(swept.status, alone.status) << swept.err;
  ASSERT_EQ(rows_of(swept.out).size(), 2u);
  for (const std::string& row : rows_of(swept.out))
    EXPECT_NE(row.find(doubt), std::string::npos) << row;
  const Outcome shown = shell(command + "--sweep run.seed=list:1,2");
  EXPECT_EQ(shown.status, swept.status);
  EXPECT_NE(on_one_line(shown.out).find(doubt), std::string::npos) << shown.out << shown.err;
}

// Each value as its command alone, with the same options; a stored sweep is printed again.
TEST(Sweep, OfAnAnalysisKeepsItsOptions) {
  const Shell shell;
  const std::string command =
      "$carom compare henon-heiles --schemes velocity-verlet --steps 0.2,0.1 --t-max 3 --json ";
  const Outcome made = shell(command + "--sweep particles.energy=list:0.05,0.1 -o a.h5");
  ASSERT_EQ(made.status, 0) << made.err;
  const std::vector<std::string> rows = rows_of(made.out);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NE(rows[1].find("\"t\": 3,"), std::string::npos) << rows[1];
  EXPECT_NE(rows[1].find("\"step\": 0.1,"), std::string::npos) << rows[1];
  const Outcome again = shell("$carom compare --resume a.h5 --json");
  EXPECT_EQ(rows_of(again.out), rows) << again.err;
  expect_refused(shell("$carom relax --resume a.h5"), "a.h5");
  ASSERT_EQ(shell("$carom compare henon-heiles --schemes velocity-verlet -o b.h5").status, 0);
  expect_refused(shell("$carom compare --resume b.h5"), "b.h5");
}

TEST(Sweep, TableFitsATerminal) {
  const Shell shell;
  const Outcome o = shell(escape + sweep + "--sweep table.width=lin:1:2:3");
  ASSERT_EQ(o.status, 0) << o.err;
  std::size_t from = 0;
  for (std::size_t end; (end = o.out.find('\n', from)) != std::string::npos; from = end + 1)
    EXPECT_LE(end - from, 80u) << o.out.substr(from, end - from);
}

}  // namespace
}  // namespace carom
