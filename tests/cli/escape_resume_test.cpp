// Escape ensembles that are killed, interrupted or short of disk go on, and end as if nothing had happened.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "archive_contents.hpp"
#include "program.hpp"

namespace carom {
namespace {

// Datasets in the form in which they must agree; nothing of /provenance is a dataset.
std::map<std::string, std::string> datasets(const Shell& shell, const std::string& file) {
  return open_archive(shell.folder() + "/" + file).datasets;
}

std::string seconds(double s) { return std::to_string(s); }

// A few tenths of a second of computing.
const std::string ensemble = " escape mushroom --trajectories 1.5e5 --t-max 400 --quiet --json";

struct Undisturbed {
  explicit Undisturbed(const Shell& shell, const std::string& options) {
    const Outcome o = shell("$carom" + ensemble + options + " -o whole.h5");
    EXPECT_EQ(o.status, 0) << o.err;
    digest = json_value(o.out, "digest");
    time = std::stod(json_value(o.out, "seconds"));
    contents = datasets(shell, "whole.h5");
    EXPECT_FALSE(contents.empty());
  }
  std::string digest;
  double time = 1.0;
  std::map<std::string, std::string> contents;
};

// A checkpoint, where there is one, is an archive that anybody can read.
void expect_whole(const Shell& shell, const std::string& file) {
  if (!shell.exists(file)) return;
  const Contents c = open_archive(shell.folder() + "/" + file);
  EXPECT_EQ(c.complete, 0) << file;
  EXPECT_TRUE(c.datasets.count("survival/p") && c.datasets.count("done/first")) << file;
  EXPECT_TRUE(c.undescribed.empty()) << file;
}

void kill_and_resume(const std::string& options, int kills, unsigned seed) {
  const Shell shell;
  const Undisturbed whole(shell, options);
  std::mt19937 random(seed);
  int killed = 0, runs = 0;
  while (killed < kills) {
    ASSERT_LT(++runs, 5 * kills) << "it ends before it is killed";
    const bool anew = !shell.exists("a.h5") && !shell.exists("a.h5.part");
    const std::string begin = anew ? ensemble + options + " -o a.h5" : " escape --resume a.h5 --quiet --json";
    const double when = whole.time * 0.5 * static_cast<double>(random() % 1000) / 1000.0;
    const std::string signal = random() % 2 ? "-9" : "-TERM";
    const Outcome o = shell("$carom" + begin + " --checkpoint 0.02 --threads " + std::to_string(1 + random() % 2) +
                            " & pid=$!; sleep " + seconds(0.01 + when) + "; kill " + signal + " $pid; wait $pid");
    expect_whole(shell, "a.h5.part");
    if (o.status == 0) {  // faster than the kill
      expect_same_datasets(shell.folder() + "/a.h5", whole.contents);
      shell("rm -f a.h5 a.h5.*");
      continue;
    }
    // A signal may come before anything is ready for it.
    if (signal == "-9") {
      EXPECT_EQ(o.status, 137) << o.err;
    } else {
      EXPECT_TRUE(o.status == 130 || o.status == 143) << o.status << o.err;
    }
    if (signal == "-TERM" && o.status == 130) {
      expect_whole(shell, "a.h5");
      EXPECT_EQ(json_value(o.out, "status"), "\"interrupted\"");
    }
    ++killed;
  }
  const Outcome end = shell("$carom escape --resume a.h5 --quiet --json");
  ASSERT_EQ(end.status, 0) << end.err;
  EXPECT_EQ(json_value(end.out, "digest"), whole.digest);
  expect_same_datasets(shell.folder() + "/a.h5", whole.contents);
  EXPECT_EQ(shell.files().size(), 2u) << "something was left";
  // What is complete is shown again, and nothing is computed.
  const Outcome again = shell("$carom escape --resume a.h5 --json");
  EXPECT_EQ(again.status, 0);
  EXPECT_EQ(json_value(again.out, "digest"), whole.digest);
  EXPECT_EQ(json_value(again.out, "seconds"), json_value(end.out, "seconds"));
}

// Five kills; fifty with CAROM_SOAK.
int kills() { return std::getenv("CAROM_SOAK") ? 25 : 3; }

TEST(EscapeResume, AfterKillsIsTheUndisturbedRun) { kill_and_resume("", kills(), 1); }

TEST(EscapeResume, AfterKillsHoldsEveryRecord) {
  kill_and_resume(" --per-trajectory --block 100", std::getenv("CAROM_SOAK") ? 25 : 2, 2);
}

// A killed run's, with something in it.
void leave_a_checkpoint(const Shell& shell) {
  shell("$carom escape mushroom --trajectories 1e9 -o a.h5 --quiet --block 4 --checkpoint 0.02 & pid=$!; "
        "until [ -e a.h5.part ]; do sleep 0.02; done; sleep 0.3; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("a.h5.part"));
}

TEST(EscapeResume, OtherwiseRefusesAndSaysWhatDiffers) {
  const Shell shell;
  leave_a_checkpoint(shell);
  const std::string before = shell.read("a.h5.part");
  const std::pair<const char*, const char*> cases[] = {
      {"--resume a.h5 --seed 2", "run.seed is 2, not 1"},
      {"--resume a.h5 --t-max 7", "run.t_max is 7, not"},
      {"--resume a.h5 --trajectories 100", "run.trajectories is 100, not 1e9"},
      {"--resume a.h5 --set table.stem_width=0.9", "table.stem_width is 0.9, not"},
      {"stadium --resume a.h5", "the system is stadium, not mushroom"},
      {"mushroom --resume a.h5", "run.trajectories is"},
      {"--resume a.h5 --engine steps", "--engine"},
      {"--resume a.h5 --per-trajectory", "--per-trajectory"},
      {"--resume a.h5 --shard 1/2", "--shard is 1/2, not 1/1"},
      {"--resume b.h5", "there is no such file"},
      {"--resume a.h5 -o b.h5", "--output"},
      {"--resume a.h5 --splitting 1,2", "--resume"},
  };
  for (const auto& [options, message] : cases) {
    const Outcome o = shell("$carom escape " + std::string(options));
    EXPECT_EQ(o.status, 1) << options;
    EXPECT_EQ(o.out, "") << options;
    EXPECT_NE(o.err.find(message), std::string::npos) << options << "\n" << o.err;
  }
  // A run anew would cost what was computed.
  const Outcome anew = shell("$carom escape mushroom --trajectories 1e9 -o a.h5");
  EXPECT_EQ(anew.status, 1);
  EXPECT_NE(anew.err.find("--resume a.h5"), std::string::npos) << anew.err;
  EXPECT_EQ(shell.read("a.h5.part"), before);
  // What is the same in another spelling is the same.
  const Outcome same = shell("$carom escape mushroom --resume a.h5 --trajectories 1000000000 --quiet --json & pid=$!; "
                             "sleep 0.5; kill -INT $pid; wait $pid");
  EXPECT_EQ(same.status, 130) << same.err;
  EXPECT_NE(same.err.find("carom escape --resume a.h5"), std::string::npos) << same.err;
  shell("$carom run stadium --t-max 3 -o run.h5; echo none > none.h5");
  EXPECT_NE(shell("$carom escape --resume run.h5").err.find("escape"), std::string::npos);
  EXPECT_NE(shell("$carom escape --resume none.h5").err.find("not an archive"), std::string::npos);
}

TEST(EscapeResume, RefusesAnotherVersion) {
  const Shell shell;
  leave_a_checkpoint(shell);
  const hid_t file = H5Fopen((shell.folder() + "/a.h5.part").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t provenance = H5Gopen2(file, "provenance", H5P_DEFAULT);
  const hid_t version = H5Aopen(provenance, "version", H5P_DEFAULT);
  const hid_t type = H5Aget_type(version);
  std::string text(H5Tget_size(type), '9');
  ASSERT_GE(H5Awrite(version, type, text.data()), 0);
  H5Tclose(type);
  H5Aclose(version);
  H5Gclose(provenance);
  H5Fclose(file);
  const Outcome o = shell("$carom escape --resume a.h5");
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.err.find("version " + text + " wrote it"), std::string::npos) << o.err;
}

TEST(EscapeResume, AfterAFullDisk) {
  const Shell shell;
  const Undisturbed whole(shell, " --per-trajectory");
  // The records reach the limit on the size of a file; the checkpoint itself does not.
  const Outcome o = shell("( ulimit -f 5000; $carom" + ensemble + " --per-trajectory -o a.h5 --checkpoint 0.02 )");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.out, "");
  EXPECT_NE(o.err.find("cannot write 'a.h5': File too large"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("carom escape --resume a.h5"), std::string::npos) << o.err;
  expect_whole(shell, "a.h5.part");
  EXPECT_GT(datasets(shell, "a.h5.part").at("done/first").size(), 0u);
  const Outcome end = shell("$carom escape --resume a.h5 --quiet --json");
  EXPECT_EQ(end.status, 0) << end.err;
  expect_same_datasets(shell.folder() + "/a.h5", whole.contents);
  EXPECT_EQ(shell.files().size(), 2u);
}

// `size`: of the disk, in kB.
void fill_the_disk(const std::string& options, int size) {
  const Shell shell;
  if (shell("mkdir small && mount -t tmpfs -o size=" + std::to_string(size) + "k carom-test small").status != 0)
    GTEST_SKIP() << "no right to mount a small disk";
  const std::string filler = "head -c " + std::to_string(2 * size) + "k /dev/zero 2>/dev/null > small/filler; ";
  const Undisturbed whole(shell, options);
  const Outcome o = shell("$carom" + ensemble + options + " -o small/a.h5 --threads 1 --checkpoint 0.03 & pid=$!; "
                          "until [ -e small/a.h5.part ]; do sleep 0.01; done; " + filler + "sleep 0.08; rm small/filler; wait $pid");
  EXPECT_EQ(o.status, 0) << o.err;
  expect_same_datasets(shell.folder() + "/small/a.h5", whole.contents);
  shell("rm small/a.h5");
  // To the end full: the old checkpoint stays.
  const Outcome full = shell("$carom" + ensemble + options + " -o small/b.h5 --threads 1 --block 4 --checkpoint 0.02 & pid=$!; "
                             "until [ -e small/b.h5.part ]; do sleep 0.01; done; sleep 0.1; " + filler + "wait $pid");
  EXPECT_EQ(full.status, 1) << full.err;
  EXPECT_EQ(full.out, "");
  EXPECT_NE(full.err.find("cannot write 'small/b.h5': No space left on device"), std::string::npos) << full.err;
  EXPECT_NE(full.err.find("carom escape --resume small/b.h5"), std::string::npos) << full.err;
  expect_whole(shell, "small/b.h5.part");
  const Outcome end = shell("rm small/filler; $carom escape --resume small/b.h5 --quiet --json");
  EXPECT_EQ(end.status, 0) << end.err;
  expect_same_datasets(shell.folder() + "/small/b.h5", whole.contents);
  EXPECT_FALSE(shell.exists("small/b.h5.part") || shell.exists("small/b.h5.records"));
  shell("umount small");
}

TEST(EscapeResume, ADiskThatIsFullForAWhileCostsNothing) { fill_the_disk("", 96); }

TEST(EscapeResume, ADiskThatIsFullForAWhileCostsNoRecords) { fill_the_disk(" --per-trajectory", 32 << 10); }

}  // namespace
}  // namespace carom
