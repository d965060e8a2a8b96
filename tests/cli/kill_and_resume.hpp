// Ensembles are killed, or run out of disk, and go on: the result is that of an undisturbed run.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "archive_contents.hpp"
#include "program.hpp"

namespace carom {

// Datasets in the form in which they must agree; nothing of /provenance is a dataset.
inline std::map<std::string, std::string> datasets(const Shell& shell, const std::string& file) {
  return open_archive(shell.folder() + "/" + file).datasets;
}

inline std::string seconds(double s) { return std::to_string(s); }

// What is to survive; a few tenths of a second of computing.
struct Ensemble {
  std::string command, what;
  std::string anew(const std::string& options) const {
    return " " + command + " " + what + " --quiet --json" + options;
  }
  std::string on(const std::string& file) const {
    return " " + command + " --resume " + file + " --quiet --json";
  }
};

struct Undisturbed {
  Undisturbed(const Shell& shell, const Ensemble& ensemble, const std::string& options) {
    const Outcome o = shell("$carom" + ensemble.anew(options) + " -o whole.h5");
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

// A checkpoint, where there is one, is an archive that other programs can read.
inline void expect_whole(const Shell& shell, const std::string& file) {
  if (!shell.exists(file)) return;
  const Contents c = open_archive(shell.folder() + "/" + file);
  EXPECT_EQ(c.complete, 0) << file;
  EXPECT_TRUE(c.datasets.count("fates/digest") && c.datasets.count("done/first")) << file;
  EXPECT_TRUE(c.undescribed.empty()) << file;
}

inline void kill_and_resume(const Ensemble& ensemble, const std::string& options, int kills,
                            unsigned seed) {
  const Shell shell;
  const Undisturbed whole(shell, ensemble, options);
  // What was killed before its first checkpoint begins anew.
  const auto begin = [&] {
    const bool anew = !shell.exists("a.h5") && !shell.exists("a.h5.part/checkpoint.h5");
    return anew ? ensemble.anew(options) + " -o a.h5" : ensemble.on("a.h5");
  };
  std::mt19937 random(seed);
  int killed = 0, runs = 0;
  double latest = 0.5 * whole.time;
  while (killed < kills) {
    ASSERT_LT(++runs, 20 * kills) << "it ends before it is killed";
    const double when = latest * static_cast<double>(random() % 1000) / 1000.0;
    const std::string signal = random() % 2 ? "-9" : "-TERM";
    const Outcome o = shell("$carom" + begin() + " --checkpoint 0.02 --threads " +
                            std::to_string(1 + random() % 2) + " & pid=$!; sleep " +
                            seconds(0.01 + when) + "; kill " + signal + " $pid; wait $pid");
    expect_whole(shell, "a.h5.part/checkpoint.h5");
    if (o.status == 0) {  // faster than the kill
      latest *= 0.8;
      expect_same_datasets(shell.folder() + "/a.h5", whole.contents);
      shell("rm -rf a.h5 a.h5.*");
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
  const Outcome end = shell("$carom" + begin());
  ASSERT_EQ(end.status, 0) << end.err;
  EXPECT_EQ(json_value(end.out, "digest"), whole.digest);
  expect_same_datasets(shell.folder() + "/a.h5", whole.contents);
  EXPECT_EQ(shell.files().size(), 2u) << "something was left";
  // What is complete is shown again, and nothing is computed.
  const Outcome again = shell("$carom" + ensemble.on("a.h5"));
  EXPECT_EQ(again.status, 0);
  EXPECT_EQ(json_value(again.out, "digest"), whole.digest);
  EXPECT_EQ(json_value(again.out, "seconds"), json_value(end.out, "seconds"));
}

// Ends with an error, whatever the machine does meanwhile: the checkpoint holds some of the
// trajectories, and their records may not grow beyond 3 MB. No checkpoint is as large.
inline std::string until_records_are_full(const Ensemble& ensemble,
                                          const std::string& file = "a.h5") {
  return "prlimit --fsize=3000000 $carom" +
         ensemble.anew(" --per-trajectory --threads 1 --block 100 --checkpoint blocks:20") +
         " -o " + file;
}

// `size`: of the disk, in kB. On a busy machine the program may end before its disk is full, or
// give up before there is room again: then it is tried once more.
inline void fill_the_disk(const Ensemble& ensemble, const std::string& options, int size) {
  const int tries = 20;
  const Shell shell;
  if (shell("mkdir small && mount -t tmpfs -o size=" + std::to_string(size) + "k carom-test small")
          .status != 0)
    GTEST_SKIP() << "no right to mount a small disk";
  const std::string filler =
      "head -c " + std::to_string(2 * size) + "k /dev/zero 2>/dev/null > small/filler; ";
  const Undisturbed whole(shell, ensemble, options);
  for (int i = 0;; ++i) {
    ASSERT_LT(i, tries);
    const Outcome o = shell("$carom" + ensemble.anew(options) +
                            " -o small/a.h5 --threads 1 --checkpoint 0.1 2>said & pid=$!; "
                            "until_there small/a.h5.part/checkpoint.h5; " +
                            filler + "until_there said; rm small/filler; wait $pid");
    const std::string said = shell.read("said");
    const bool warned = said.find("'small/a.h5'") != std::string::npos;
    ASSERT_TRUE(o.status == 0 || warned) << said;
    if (o.status == 0 && warned) break;
    shell("rm -rf small/* said");
  }
  expect_same_datasets(shell.folder() + "/small/a.h5", whole.contents);
  shell("rm small/a.h5");
  // To the end full: the old checkpoint stays.
  Outcome full;
  for (int i = 0;; ++i) {
    ASSERT_LT(i, tries);
    full = shell("$carom" + ensemble.anew(options) +
                 " -o small/b.h5 --threads 1 --block 4 --checkpoint blocks:100 & pid=$!; "
                 "until_saved small/b.h5; " +
                 filler + "wait $pid");
    if (full.status != 0) break;
    shell("rm -rf small/*");
  }
  EXPECT_EQ(full.status, 1) << full.err;
  EXPECT_EQ(full.out, "");
  EXPECT_NE(full.err.find("'small/b.h5'"), std::string::npos) << full.err;
  EXPECT_NE(full.err.find("carom " + ensemble.command + " --resume small/b.h5"), std::string::npos)
      << full.err;
  expect_whole(shell, "small/b.h5.part/checkpoint.h5");
  const Outcome end = shell("rm small/filler; $carom" + ensemble.on("small/b.h5"));
  EXPECT_EQ(end.status, 0) << end.err;
  expect_same_datasets(shell.folder() + "/small/b.h5", whole.contents);
  EXPECT_FALSE(shell.exists("small/b.h5.part"));
  shell("umount small");
}

}  // namespace carom
