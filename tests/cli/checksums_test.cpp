// A changed bit in what an archive or the records of a checkpoint hold is told of, where no other number would show it.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "program.hpp"

namespace carom {
namespace {

std::vector<double> read_reals(const std::string& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), dataset = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  return values;
}

bool can_be_read(const std::string& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), dataset = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const bool ok = H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  return ok;
}

// The lowest bit of a stored number: the file stays an archive, and the number one that might be right.
void change_last_bit(const std::string& path, double number) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&number), sizeof number));
  ASSERT_NE(at, std::string::npos) << path;
  file.clear();
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(bytes[at] ^ 1));
}

// A text that stands in a file once, for another of its length.
void change_text(const std::string& path, const std::string& from, const std::string& to) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t at = bytes.find(from);
  ASSERT_NE(at, std::string::npos) << path;
  file.clear();
  file.seekp(static_cast<std::streamoff>(at));
  file << to;
}

void remove_checksum(const std::string& path, const char* dataset) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), text = H5Dopen2(file, dataset, H5P_DEFAULT);
  EXPECT_GE(H5Adelete(text, "crc32"), 0);
  H5Dclose(text);
  H5Fclose(file);
}

void expect_changed(const Outcome& o, const std::string& file, const char* text) {
  EXPECT_EQ(o.status, 1) << file;
  EXPECT_EQ(o.out, "");
  EXPECT_NE(o.err.find(file + ": the text '" + text + "' was changed: its checksum is another"), std::string::npos) << o.err;
}

// Two systems would be added up as one.
TEST(Checksums, AChangedSystemOfACheckpointIsRefused) {
  const Shell shell;
  shell("$carom escape mushroom --trajectories 1e9 -o a.h5 --quiet --block 4 --checkpoint blocks:2000 & pid=$!; "
        "until_saved a.h5; kill -9 $pid; wait $pid");
  const std::string checkpoint = shell.folder() + "/a.h5.part";
  change_text(checkpoint, "stem_width = 1", "stem_width = 2");
  expect_changed(shell("timeout 20 $carom escape --resume a.h5"), "a.h5.part", "system");
  expect_changed(shell("$carom merge sum.h5 a.h5"), "a.h5.part", "system");
  EXPECT_TRUE(shell.exists("a.h5.part") && !shell.exists("a.h5") && !shell.exists("sum.h5"));
  // As it was, it goes on; so does one of an earlier build, which has no checksum.
  change_text(checkpoint, "stem_width = 2", "stem_width = 1");
  const std::string go_on = "$carom escape --resume a.h5 --quiet --checkpoint blocks:20 & pid=$!; until_saved a.h5; kill -9 $pid; wait $pid";
  EXPECT_EQ(shell(go_on).status, 137);
  remove_checksum(checkpoint, "system");
  EXPECT_EQ(shell(go_on).status, 137);
}

TEST(Checksums, AChangedTextOfAnArchiveIsRefused) {
  const Shell shell;
  const std::string lossy = " henon-heiles --trajectories 20 --set particles.energy=2 --set integrator.step=0.01 --t-max 100 --quiet ";
  ASSERT_EQ(shell("$carom run mushroom --t-max 3 -o run.h5 --quiet && $carom diffusion lorentz-triangular --trajectories 50 --t-max 5 -o d.h5 --quiet").status, 0);
  ASSERT_EQ(shell("$carom escape" + lossy + "-o lost.h5").status, 3);
  struct Case {
    const char *command, *file, *from, *to, *text;
  };
  const Case cases[] = {{"run --resume run.h5 --t-max 5", "run.h5", "stem_width = 1", "stem_width = 2", "system"},
                        {"diffusion --resume d.h5", "d.h5", "shape = ", "shapf = ", "system"},
                        {"escape --resume lost.h5", "lost.h5", "step = 0.01", "step = 0.02", "system"},
                        {"escape --resume lost.h5", "lost.h5", "; unresolved at t", "; unresolvec at t", "lost"}};
  for (const Case& one : cases) {
    ASSERT_EQ(shell(std::string("cp ") + one.file + " kept").status, 0);
    change_text(shell.folder() + "/" + one.file, one.from, one.to);
    expect_changed(shell(std::string("$carom ") + one.command), one.file, one.text);
    remove_checksum(shell.folder() + "/" + one.file, one.text);
    const Outcome o = shell(std::string("$carom ") + one.command);
    EXPECT_EQ(o.err.find("checksum"), std::string::npos) << o.err;
    ASSERT_EQ(shell(std::string("mv kept ") + one.file).status, 0);
  }
}

// What a run goes on from.
TEST(Checksums, ABitOfAStateIsToldOf) {
  const Shell shell;
  ASSERT_EQ(shell("$carom run stadium --set 'table.hole=[]' --t-max 30 -o a.h5 --quiet").status, 0);
  for (const char* column : {"state/vx", "state/u", "trust/error"}) {
    ASSERT_EQ(shell("cp a.h5 b.h5").status, 0);
    const std::string path = shell.folder() + "/b.h5";
    change_last_bit(path, read_reals(path, column).at(0));
    const Outcome o = shell("$carom run --resume b.h5 --t-max 40 --quiet");
    EXPECT_EQ(o.status, 1) << column;
    EXPECT_NE(o.err.find("b.h5: '"), std::string::npos) << o.err;
  }
}

TEST(Checksums, ABitOfARecordIsToldOf) {
  const Shell shell;
  ASSERT_EQ(shell("$carom escape stadium --trajectories 2000 --t-max 20 --per-trajectory --shard 1/2 -o a.h5 --quiet && "
                  "$carom escape stadium --trajectories 2000 --t-max 20 --per-trajectory --shard 2/2 -o b.h5 --quiet").status, 0);
  for (const char* column : {"trajectories/x", "trajectories/vy", "trajectories/t"}) {
    ASSERT_EQ(shell("cp a.h5 c.h5").status, 0);
    change_last_bit(shell.folder() + "/c.h5", read_reals(shell.folder() + "/c.h5", column).at(700));
    const Outcome o = shell("$carom merge sum.h5 c.h5 b.h5");
    EXPECT_EQ(o.status, 1) << column;
    EXPECT_NE(o.err.find("c.h5: "), std::string::npos) << o.err;
    EXPECT_FALSE(shell.exists("sum.h5"));
  }
}

// Archives that are written aside hold checksums, too; no reader comes before they are whole.
TEST(Checksums, ABitOfASectionOrCertifiedOrbitIsToldOf) {
  const Shell shell;
  ASSERT_EQ(shell("$carom section stadium --orbits 3 --points 500 -o s.h5 --quiet && "
                  "$carom run stadium --precision certified --collisions 40 -o c.h5 --quiet").status, 0);
  for (const auto& [name, column] : {std::pair{"s.h5", "section/x"}, {"c.h5", "collisions/x"}}) {
    const std::string path = shell.folder() + "/" + name;
    EXPECT_TRUE(can_be_read(path, column)) << name;
    change_last_bit(path, read_reals(path, column).at(3));
    EXPECT_FALSE(can_be_read(path, column)) << name;
  }
}

// Before anything is computed: what goes on from damaged records would be thrown away in the end.
TEST(Checksums, ABitOfTheRecordsOfACheckpointIsToldOfAtOnce) {
  const Shell shell;
  shell("$carom escape mushroom --trajectories 1e9 --per-trajectory -o a.h5 --quiet --block 4 --checkpoint blocks:2000 & pid=$!; "
        "until_there a.h5.records; until_saved a.h5; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("a.h5.part"));
  // Bytes 8 to 15 of the first record: where the trajectory started.
  double x = 0;
  std::ifstream(shell.folder() + "/a.h5.records", std::ios::binary).seekg(8).read(reinterpret_cast<char*>(&x), sizeof x);
  ASSERT_EQ(shell("cp a.h5.records kept").status, 0);
  change_last_bit(shell.folder() + "/a.h5.records", x);
  const Outcome o = shell("timeout 20 $carom escape --resume a.h5");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.out, "");
  EXPECT_NE(o.err.find("a.h5.records: the records of the trajectories "), std::string::npos) << o.err;
  EXPECT_TRUE(shell.exists("a.h5.part") && shell.exists("a.h5.records") && !shell.exists("a.h5"));
  // Mended, they go on.
  const Outcome again = shell("cp kept a.h5.records; $carom escape --resume a.h5 --quiet --checkpoint blocks:20 & pid=$!; until_saved a.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(again.status, 130) << again.err;
}

}  // namespace
}  // namespace carom
