// Escape ensembles that are killed, interrupted or short of disk go on, and end as if nothing had
// happened.
#include <gtest/gtest.h>

#include <fstream>

#include "files/hdf5/checksums.hpp"
#include "files/hdf5/hdf5.hpp"
#include "kill_and_resume.hpp"
#include "soak.hpp"

namespace carom {
namespace {

const Ensemble mushroom{"escape", "mushroom --trajectories 1.5e5 --t-max 4000"};

// Five kills; fifty with CAROM_SOAK.
int kills() { return tests::soak() ? 25 : 3; }

TEST(EscapeResume, AKilledRunEndsAsTheUndisturbedOne) { kill_and_resume(mushroom, "", kills(), 1); }

TEST(EscapeResume, AKilledRunFromQuasiRandomStartsEndsAsTheUndisturbedOne) {
  kill_and_resume(mushroom, " --set initial.kind=sobol", 2, 3);
}

TEST(EscapeResume, AKilledRunKeepsEveryRecord) {
  kill_and_resume(mushroom, " --per-trajectory --block 100", tests::soak() ? 25 : 2, 2);
}

// A killed run's, with something in it.
void leave_a_checkpoint(const Shell& shell) {
  shell(
      "$carom escape mushroom --trajectories 1e9 -o a.h5 --quiet --block 4 --checkpoint "
      "blocks:2000 & pid=$!; "
      "until_saved a.h5; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("a.h5.part/checkpoint.h5"));
}

// A run that goes on with an archive copies its records before its first checkpoint.
TEST(EscapeResume, AKillWithinTheCopyOfRecordsLosesNothing) {
  const Shell shell;
  // An archive of the first trajectories, and records as such a run leaves them.
  shell(
      "$carom escape mushroom --trajectories 1e9 --t-max 100 --per-trajectory --threads 1 --block "
      "100 -o a.h5 --quiet --checkpoint blocks:100 & pid=$!; "
      "until_saved a.h5; kill -9 $pid; wait $pid");
  const std::string records = shell.read("a.h5.part/records");
  ASSERT_GT(records.size(), 10000u);
  shell(
      "$carom escape --resume a.h5 --quiet --checkpoint blocks:20 & pid=$!; until_saved a.h5; kill "
      "-TERM $pid; wait $pid");
  ASSERT_TRUE(shell.exists("a.h5"));
  ASSERT_FALSE(shell.exists("a.h5.part"));
  ASSERT_EQ(shell("mkdir a.h5.part && : > a.h5.part/carom.lock").status, 0);
  std::ofstream(shell.folder() + "/a.h5.part/records", std::ios::binary) << records.substr(0, 9000);
  const Outcome on = shell(
      "$carom escape --resume a.h5 --quiet --checkpoint blocks:20 & pid=$!; until_saved a.h5; kill "
      "-TERM $pid; wait $pid");
  EXPECT_EQ(on.status, 130) << on.err;
  EXPECT_FALSE(shell.exists("a.h5.part"));
}

TEST(EscapeResume, ADifferentEnsembleIsRefusedWithWhatDiffers) {
  const Shell shell;
  leave_a_checkpoint(shell);
  const std::string before = shell.read("a.h5.part/checkpoint.h5");
  const std::pair<const char*, const char*> cases[] = {
      {"--resume a.h5 --seed 2", "run.seed"},
      {"--resume a.h5 --t-max 7", "run.t_max"},
      {"--resume a.h5 --trajectories 100", "run.trajectories"},
      {"--resume a.h5 --set table.stem_width=0.9", "table.stem_width"},
      {"stadium --resume a.h5", "stadium"},
      {"mushroom --resume a.h5", "run.trajectories"},
      {"--resume a.h5 --engine steps", "--engine"},
      {"--resume a.h5 --per-trajectory", "--per-trajectory"},
      {"--resume a.h5 --shard 1/2", "--shard"},
      {"--resume b.h5", "b.h5"},
      {"--resume a.h5 --checkpoint 1e9", "--checkpoint"},
      {"--resume a.h5 --checkpoint blocks:0", "--checkpoint"},
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
  EXPECT_EQ(shell.read("a.h5.part/checkpoint.h5"), before);
  // What is the same in another spelling is the same.
  const Outcome same = shell(
      "$carom escape mushroom --resume a.h5 --trajectories 1000000000 --quiet --json --checkpoint "
      "blocks:20 & pid=$!; "
      "until_saved a.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(same.status, 130) << same.err;
  EXPECT_NE(same.err.find("carom escape --resume a.h5"), std::string::npos) << same.err;
  shell("$carom run stadium --t-max 3 -o run.h5; echo none > none.h5");
  expect_refused(shell("$carom escape --resume run.h5"), "run.h5: ");
  expect_refused(shell("$carom escape --resume none.h5"), "none.h5: ");
}

// Of a system file the contents count, and not the name.
TEST(EscapeResume, TheFileOfTheSystemMayBeRenamed) {
  const Shell shell;
  ASSERT_EQ(shell("$carom systems stadium > m.toml; for k in 1 2; do $carom escape ./m.toml "
                  "--trajectories 100 --shard $k/2 --quiet -o $k.h5 || exit 9; done; "
                  "mv m.toml n.toml; sed 's/^radius.*/radius = 2/' n.toml > other.toml; ! cmp "
                  "n.toml other.toml >/dev/null && $carom merge half.h5 1.h5")
                .status,
            0);
  const Outcome other = shell("$carom escape ./other.toml --trajectories 100 --resume half.h5");
  expect_refused(other, "half.h5: ");
  EXPECT_NE(other.err.find("table.radius"), std::string::npos) << other.err;
  const Outcome same =
      shell("$carom escape ./n.toml --trajectories 100 --resume half.h5 --quiet --json");
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(json_value(same.out, "status"), "\"completed\"");
}

TEST(EscapeResume, NamesTheRecordsThatAreMissing) {
  const Shell shell;
  shell(
      "$carom escape mushroom --trajectories 1e9 --per-trajectory -o a.h5 --quiet --block 4 "
      "--checkpoint blocks:2000 & pid=$!; "
      "until_saved a.h5; kill -9 $pid; wait $pid");
  const std::string records = shell.read("a.h5.part/records");
  ASSERT_NE(records, "");
  const Outcome cut = shell("truncate -s 50 a.h5.part/records; $carom escape --resume a.h5");
  expect_refused(cut, "a.h5.part/records: ");
  const Outcome gone = shell("rm a.h5.part/records; $carom escape --resume a.h5");
  expect_refused(gone, "a.h5.part/records: ");
  EXPECT_TRUE(shell.exists("a.h5.part/checkpoint.h5"));
}

// Sets a text attribute of /provenance to 9s, or removes it. Its checksums are right.
void change_provenance(const std::string& path, const char* name, bool remove = false) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
              provenance = H5Gopen2(file, "provenance", H5P_DEFAULT);
  if (remove) {
    EXPECT_GE(H5Adelete(provenance, name), 0);
  } else {
    files::hdf5::change_attribute(provenance, name, std::string_view("99999999"), path);
  }
  H5Gclose(provenance);
  files::hdf5::write_checksums(file, path);
  H5Fclose(file);
}

// Builds of one version whose digits differ. What is complete is shown. Builds that kept no
// fingerprint had other digests.
TEST(EscapeResume, RefusesAnotherArithmetic) {
  const Shell shell;
  ASSERT_EQ(shell("for k in 1 2; do $carom escape stadium --trajectories 100 --shard $k/2 --quiet "
                  "-o $k.h5 || exit 9; done; "
                  "$carom merge half.h5 1.h5 && cp half.h5 old.h5")
                .status,
            0);
  for (const std::string file : {"half.h5", "2.h5"})
    change_provenance(shell.folder() + "/" + file, "arithmetic");
  for (const std::string command :
       {"escape --resume half.h5", "merge all.h5 1.h5 2.h5", "merge all.h5 2.h5 1.h5"}) {
    const Outcome o = shell("$carom " + command);
    EXPECT_EQ(o.status, 1) << command;
    EXPECT_EQ(o.out, "") << command;
    EXPECT_NE(o.err.find(".h5: arithmetic: "), std::string::npos) << o.err;
    EXPECT_FALSE(shell.exists("all.h5"));
  }
  EXPECT_EQ(shell("$carom escape --resume 2.h5 --quiet").status, 0);
  for (const std::string file : {"old.h5", "2.h5"})
    change_provenance(shell.folder() + "/" + file, "arithmetic", true);
  for (const std::string command : {"escape --resume old.h5", "merge all.h5 1.h5 2.h5"}) {
    const Outcome o = shell("$carom " + command);
    EXPECT_EQ(o.status, 1) << command;
    EXPECT_NE(o.err.find(".h5: arithmetic: "), std::string::npos) << o.err;
  }
}

TEST(EscapeResume, RefusesAnotherVersion) {
  const Shell shell;
  leave_a_checkpoint(shell);
  change_provenance(shell.folder() + "/a.h5.part/checkpoint.h5", "version");
  const Outcome o = shell("$carom escape --resume a.h5");
  expect_refused(o, "a.h5.part/checkpoint.h5: ");
  EXPECT_NE(o.err.find("99999"), std::string::npos) << o.err;
}

// With --force over anything: until it is replaced, what is there says nothing about the
// checkpoint.
TEST(EscapeResume, AFileOfAnotherKindIsReplacedAtTheEnd) {
  const std::string files[] = {
      "$carom run stadium --t-max 3 -o a.h5", "echo none > a.h5",
      "$carom diffusion lorentz-triangular --trajectories 10 --t-max 5 -o a.h5"};
  const Shell shell;
  const Undisturbed whole(shell, mushroom, " --per-trajectory");
  for (const std::string& file : files) {
    ASSERT_EQ(shell("rm -rf a.h5*; " + file).status, 0);
    ASSERT_EQ(shell(until_records_are_full(mushroom) + " --force").status, 1);
    ASSERT_TRUE(shell.exists("a.h5") && shell.exists("a.h5.part/checkpoint.h5"));
    const Outcome o = shell("$carom" + mushroom.on("a.h5"));
    EXPECT_EQ(o.status, 0) << file << "\n" << o.err;
    expect_same_datasets(shell.folder() + "/a.h5", whole.contents);
    EXPECT_EQ(shell.files().size(), 2u);
  }
}

TEST(EscapeResume, ARunGoesOnAfterAFullDisk) {
  const Shell shell;
  const Undisturbed whole(shell, mushroom, " --per-trajectory");
  const Outcome o = shell(until_records_are_full(mushroom));
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.out, "");
  EXPECT_NE(o.err.find("'a.h5'"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("carom escape --resume a.h5"), std::string::npos) << o.err;
  expect_whole(shell, "a.h5.part/checkpoint.h5");
  EXPECT_GT(datasets(shell, "a.h5.part/checkpoint.h5").at("done/first").size(), 0u);
  const Outcome end = shell("$carom escape --resume a.h5 --quiet --json");
  EXPECT_EQ(end.status, 0) << end.err;
  expect_same_datasets(shell.folder() + "/a.h5", whole.contents);
  EXPECT_EQ(shell.files().size(), 2u);
}

TEST(EscapeResume, ADiskThatIsFullForAWhileCostsNothing) { fill_the_disk(mushroom, "", 256); }

TEST(EscapeResume, ADiskThatIsFullForAWhileCostsNoRecords) {
  fill_the_disk(mushroom, " --per-trajectory", 32 << 10);
}

}  // namespace
}  // namespace carom
