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
  shell("$carom escape mushroom --trajectories 1e9 --per-trajectory -o a.h5 --quiet --block 4 --checkpoint 0.02 & pid=$!; "
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
  const Outcome again = shell("cp kept a.h5.records; $carom escape --resume a.h5 --quiet --checkpoint 0.05 & pid=$!; until_saved a.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(again.status, 130) << again.err;
}

}  // namespace
}  // namespace carom
