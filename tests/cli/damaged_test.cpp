// Damaged or changed archives of ensembles are refused, with file and dataset.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "files/hdf5/checksums.hpp"
#include "program.hpp"

namespace carom {
namespace {

// Opens a file for changes with HDF5 alone. Afterwards its checksums are right: what it says
// contradicts itself.
class Damage {
 public:
  explicit Damage(const std::string& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)) {
    EXPECT_GE(file_, 0);
  }
  ~Damage() {
    files::hdf5::write_checksums(file_, "b.h5");
    H5Fclose(file_);
  }
  Damage(const Damage&) = delete;

  void set_first(const char* dataset, std::uint64_t value) {
    change<std::uint64_t>(dataset, H5T_NATIVE_UINT64, [=](auto& v) { v.at(0) = value; });
  }
  void add_to_first(const char* dataset) {
    change<std::uint64_t>(dataset, H5T_NATIVE_UINT64, [](auto& v) { ++v.at(0); });
  }
  void move_first(const char* dataset) {
    change<double>(dataset, H5T_NATIVE_DOUBLE, [](auto& v) { v.at(0) *= 0.5; });
  }
  // The same dataset with other rows.
  void resize(const char* dataset, hsize_t rows) {
    H5Ldelete(file_, dataset, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(1, &rows, nullptr);
    const hid_t made =
        H5Dcreate2(file_, dataset, H5T_NATIVE_UINT64, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(made, 0) << dataset;
    H5Dclose(made);
    H5Sclose(space);
  }
  void write_text(const char* dataset, const std::string& text) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, text.size());
    const hid_t made =
        H5Dcreate2(file_, dataset, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), 0);
    H5Dclose(made);
    H5Sclose(space);
    H5Tclose(type);
  }
  void remove(const char* dataset) { EXPECT_GE(H5Ldelete(file_, dataset, H5P_DEFAULT), 0); }
  void set_attribute(const char* object, const char* name, std::int64_t value) {
    const hid_t owner = H5Oopen(file_, object, H5P_DEFAULT),
                attribute = H5Aopen(owner, name, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(attribute, H5T_NATIVE_INT64, &value), 0);
    H5Aclose(attribute);
    H5Oclose(owner);
  }
  void set_complete() { set_attribute("/", "complete", 1); }

 private:
  template <class T, class Change>
  void change(const char* name, hid_t type, Change what) {
    const hid_t dataset = H5Dopen2(file_, name, H5P_DEFAULT), space = H5Dget_space(dataset);
    std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    what(values);
    EXPECT_GE(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Sclose(space);
    H5Dclose(dataset);
  }
  hid_t file_;
};

struct Case {
  std::function<void(Damage&)> damage;
  const char* message;
};

// Every command that reads a damaged copy of a.h5 reports the damage.
void expect_told(const Shell& shell, const std::string& command, const std::vector<Case>& cases) {
  for (const Case& one : cases) {
    ASSERT_EQ(shell("cp a.h5 b.h5").status, 0);
    {
      Damage damage(shell.folder() + "/b.h5");
      one.damage(damage);
    }
    for (const std::string& what : {command + " --resume b.h5", std::string("merge all.h5 b.h5")}) {
      const Outcome o = shell("$carom " + what);
      EXPECT_EQ(o.status, 1) << what << ": " << one.message;
      EXPECT_EQ(o.out, "") << what << ": " << one.message;
      EXPECT_NE(o.err.find(std::string("b.h5: ") + one.message), std::string::npos)
          << what << ": " << one.message << "\n"
          << o.err;
    }
  }
}

TEST(Damaged, EscapeNamesTheDataset) {
  const Shell shell;
  ASSERT_EQ(shell("$carom escape stadium --trajectories 200 --t-max 20 -o a.h5").status, 0);
  expect_told(
      shell, "escape",
      {
          {[](Damage& d) { d.set_first("done/first", 5000); },
           "'/done/first' is not below '/done/last'"},
          {[](Damage& d) { d.resize("done/last", 0); },
           "'/done/first' and '/done/last' differ in length"},
          {[](Damage& d) { d.set_first("done/last", 150); },
           "it says that it is complete, and '/done' has gaps"},
          {[](Damage& d) { d.set_first("done/last", 300); },
           "'/done' counts others than the trajectories 0 to 199"},
          {[](Damage& d) { d.move_first("survival/t"); },
           "'/survival/t' are not the report times of '/system'"},
          {[](Damage& d) { d.resize("survival/gone", 2); }, "'/survival/gone' has lost rows"},
          {[](Damage& d) { d.set_first("survival/gone", 500); },
           "'/survival/gone' has more than '/fates'"},
          {[](Damage& d) { d.set_first("survival_hits/gone", 500); },
           "'/survival_hits/gone' has more than '/fates'"},
          {[](Damage& d) { d.resize("survival_hits/gone", 1000); },
           "'/survival_hits/gone' is too long"},
          {[](Damage& d) { d.resize("fates/escaped", 0); }, "'/fates/escaped' is not one number"},
          {[](Damage& d) { d.resize("fates/digest", 2); }, "'/fates/digest' is not one number"},
          {[](Damage& d) { d.add_to_first("fates/escaped"); },
           "'/fates' do not add up to '/fates/trajectories'"},
          {[](Damage& d) {
             d.add_to_first("fates/trajectories"), d.add_to_first("fates/survived");
           },
           "'/fates/trajectories' is not the number of particles that '/done' counts"},
          {[](Damage& d) { d.resize("fates/holes", 7); },
           "'/fates/holes' are not the holes of '/system'"},
          {[](Damage& d) { d.set_first("fates/holes", 5); },
           "'/fates/holes' and '/fates/unbounded' do not add up to '/fates/escaped'"},
          {[](Damage& d) { d.set_first("fates/pinned", 201); },
           "'/fates/pinned' and '/fates/capped' are more than '/fates/survived'"},
          {[](Damage& d) { d.set_first("fates/collisions", 1); },
           "'/fates/collisions' and '/fates/most_hits' contradict each other"},
          {[](Damage& d) { d.set_first("fates/most_hits", 0); },
           "'/fates/collisions' and '/fates/most_hits' contradict each other"},
          {[](Damage& d) { d.write_text("lost", "somewhere\n"); },
           "a line of '/lost' does not begin with an index"},
          {[](Damage& d) { d.write_text("lost", "1x\tsomewhere\n"); },
           "a line of '/lost' does not begin with an index"},
          {[](Damage& d) { d.set_attribute("provenance", "continued", -1); },
           "'/provenance/continued' is negative"},
          {[](Damage& d) { d.remove("done"); }, "'done' is missing"},
      });
}

TEST(Damaged, DiffusionNamesTheDataset) {
  const Shell shell;
  ASSERT_EQ(shell("$carom diffusion lorentz-triangular --trajectories 50 --t-max 5 -o a.h5").status,
            0);
  expect_told(
      shell, "diffusion",
      {
          {[](Damage& d) { d.move_first("msd/t"); },
           "'/msd/t' are not the report times of '/system'"},
          {[](Damage& d) { d.resize("msd_groups/count", 3); }, "'/msd_groups/count' has lost rows"},
          {[](Damage& d) { d.resize("fates/trajectories", 0); },
           "'/fates/trajectories' is not one number"},
          {[](Damage& d) { d.resize("fates/energy_change", 0); },
           "'/fates/energy_change' is not one number"},
          {[](Damage& d) {
             d.add_to_first("fates/trajectories"), d.add_to_first("fates/survived");
           },
           "'/fates/trajectories' is not the number of particles that '/done' counts"},
          {[](Damage& d) { d.set_first("fates/survived", 3); },
           "'/fates' do not add up to '/fates/trajectories'"},
          {[](Damage& d) { d.set_first("fates/pinned", 51); },
           "'/fates/pinned' and '/fates/capped' are more than '/fates/survived'"},
          {[](Damage& d) { d.set_first("fates/capped", 51); },
           "'/fates/pinned' and '/fates/capped' are more than '/fates/survived'"},
          {[](Damage& d) { d.set_first("msd_groups/count", 0); },
           "'/msd_groups/count' and '/fates' contradict each other"},
      });
}

// The checksums of datasets: a changed byte in the sum of hashes, which nothing else would tell.
TEST(Damaged, ABitOfTheDigestIsToldOf) {
  const Shell shell;
  ASSERT_EQ(shell("$carom escape stadium --trajectories 200 --t-max 20 -o a.h5").status, 0);
  std::uint64_t digest = 0;
  {
    const hid_t file = H5Fopen((shell.folder() + "/a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t dataset = H5Dopen2(file, "fates/digest", H5P_DEFAULT);
    EXPECT_GE(H5Dread(dataset, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &digest), 0);
    H5Dclose(dataset);
    H5Fclose(file);
  }
  std::fstream file(shell.folder() + "/a.h5", std::ios::in | std::ios::out | std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t at =
      bytes.find(std::string(reinterpret_cast<const char*>(&digest), sizeof digest));
  ASSERT_NE(at, std::string::npos);
  file.clear();
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(bytes[at] ^ 1));
  file.close();
  const Outcome o = shell("$carom escape --resume a.h5");
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.err.find("digest"), std::string::npos) << o.err;
}

TEST(Damaged, RecordsAreOneOfEachParticleInOrder) {
  const Shell shell;
  ASSERT_EQ(shell("$carom escape stadium --trajectories 200 --t-max 20 --per-trajectory --shard "
                  "1/2 -o a.h5 --quiet && "
                  "$carom escape stadium --trajectories 200 --t-max 20 --per-trajectory --shard "
                  "2/2 -o 2.h5 --quiet")
                .status,
            0);
  const auto message = [&](auto damage) {
    EXPECT_EQ(shell("cp a.h5 b.h5").status, 0);
    damage(Damage(shell.folder() + "/b.h5"));
    const Outcome o = shell("$carom merge --force all.h5 b.h5 2.h5");
    EXPECT_EQ(o.status, 1);
    return o.err;
  };
  const auto told = [](const std::string& text, const char* what) {
    return text.find(what) != std::string::npos;
  };
  const char* columns[] = {"index", "x",          "y",    "vx",   "vy", "wall",
                           "s",     "v_parallel", "fate", "hole", "t",  "hits"};
  const std::string cut = message([&](Damage&& d) {
    for (const char* column : columns)
      d.resize((std::string("trajectories/") + column).c_str(), 10);
  });
  EXPECT_TRUE(told(cut, "'/trajectories' has not one row a particle of '/fates'")) << cut;
  const std::string uneven = message([](Damage&& d) { d.resize("trajectories/hits", 10); });
  EXPECT_TRUE(told(uneven, "'/trajectories/hits' has another length than its neighbours"))
      << uneven;
  const std::string order = message([](Damage&& d) { d.set_first("trajectories/index", 7); });
  EXPECT_TRUE(told(order, "'/trajectories/index' is not in order")) << order;
}

TEST(Damaged, APartIsNotTheWhole) {
  const Shell shell;
  ASSERT_EQ(
      shell("$carom escape stadium --trajectories 200 --t-max 20 --shard 1/2 -o 1.h5 --quiet && "
            "$carom escape stadium --trajectories 200 --t-max 20 --shard 2/2 -o 2.h5 --quiet && "
            "$carom merge half.h5 1.h5")
          .status,
      0);
  Damage(shell.folder() + "/half.h5").set_complete();
  const Outcome o = shell("$carom escape --resume half.h5");
  expect_refused(o, "half.h5: ");
  EXPECT_NE(o.err.find("'/done'"), std::string::npos) << o.err;
}

TEST(Damaged, RecordsOfOthersAreRefused) {
  const Shell shell;
  shell(
      "$carom escape mushroom --trajectories 1e9 --per-trajectory -o a.h5 --quiet --block 4 "
      "--checkpoint blocks:2000 & pid=$!; "
      "until_saved a.h5; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("a.h5.part/checkpoint.h5"));
  Damage(shell.folder() + "/a.h5.part/checkpoint.h5").resize("records/rows", 0);
  const Outcome length = shell("timeout 300 $carom escape --resume a.h5");
  expect_refused(length, "a.h5.part/checkpoint.h5: '/records/rows' ");
  {
    Damage damage(shell.folder() + "/a.h5.part/checkpoint.h5");
    for (const char* column : {"first", "last", "row", "rows"})
      damage.resize((std::string("records/") + column).c_str(), 0);
  }
  const Outcome others = shell("timeout 300 $carom escape --resume a.h5");
  EXPECT_EQ(others.status, 1);
  EXPECT_NE(
      others.err.find(
          "a.h5.part/checkpoint.h5: '/records' holds others than the trajectories of '/done'"),
      std::string::npos)
      << others.err;
}

// Headers have checksums; the heap to which HDF5 moves many attributes is read beyond its end where
// it is damaged.
TEST(Damaged, AttributesAreInHeaders) {
  const Shell shell;
  ASSERT_EQ(shell("$carom escape stadium --trajectories 100 -o a.h5").status, 0);
  const hid_t file = H5Fopen((shell.folder() + "/a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t provenance = H5Gopen2(file, "provenance", H5P_DEFAULT),
              creation = H5Gget_create_plist(provenance);
  unsigned most = 0, least = 0;
  EXPECT_GE(H5Pget_attr_phase_change(creation, &most, &least), 0);
  EXPECT_GT(most, 1000u);
  H5Pclose(creation);
  H5Gclose(provenance);
  H5Fclose(file);
}

}  // namespace
}  // namespace carom
