// A changed bit in what an archive or the records of a checkpoint hold is reported, where no other
// number would show it.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "carom/base/error.hpp"
#include "files/hdf5/checksums.hpp"
#include "program.hpp"
#include "soak.hpp"

namespace carom {
namespace {

std::vector<double> read_reals(const std::string& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              dataset = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  return values;
}

bool can_be_read(const std::string& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              dataset = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const bool ok =
      H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  return ok;
}

// The lowest bit of a stored number: the file stays an archive, and the number one that might be
// right.
void change_last_bit(const std::string& path, double number) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t at =
      bytes.find(std::string(reinterpret_cast<const char*>(&number), sizeof number));
  ASSERT_NE(at, std::string::npos) << path;
  file.clear();
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(bytes[at] ^ 1));
}

// The same somewhere in the last of the chunks that hold a column, which may be compressed.
void change_bit_of(const std::string& path, const char* column) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              dataset = H5Dopen2(file, column, H5P_DEFAULT), space = H5Dget_space(dataset);
  hsize_t chunks = 0, first = 0, size = 0;
  haddr_t start = 0;
  unsigned left_out = 0;
  EXPECT_GE(H5Dget_num_chunks(dataset, space, &chunks), 0);
  EXPECT_GE(H5Dget_chunk_info(dataset, space, chunks - 1, &first, &left_out, &start, &size), 0);
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  std::fstream bytes(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto at = static_cast<std::streamoff>(start + size / 2);
  bytes.seekg(at);
  const int old = bytes.get();
  bytes.seekp(at);
  bytes.put(static_cast<char>(old ^ 1));
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

// Changes to a file through HDF5, which knows nothing of the checksums.
void with_file(const std::string& path, const std::function<void(hid_t)>& change) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
  ASSERT_GE(file, 0);
  change(file);
  H5Fclose(file);
  H5Pclose(access);
}

void expect_changed(const Outcome& o, const std::string& file, const std::string& path) {
  EXPECT_EQ(o.status, 1) << file;
  EXPECT_EQ(o.out, "");
  EXPECT_NE(o.err.find(file + ": '" + path + "' was changed: its checksum is another"),
            std::string::npos)
      << o.err;
}

// Two systems would be added up as one.
TEST(Checksums, AChangedSystemOfACheckpointIsRefused) {
  const Shell shell;
  shell(
      "$carom escape mushroom --trajectories 1e9 -o a.h5 --quiet --block 4 --checkpoint "
      "blocks:2000 & pid=$!; "
      "until_saved a.h5; kill -9 $pid; wait $pid");
  const std::string checkpoint = shell.folder() + "/a.h5.part/checkpoint.h5";
  change_text(checkpoint, "stem_width = 1", "stem_width = 2");
  expect_changed(shell("timeout 300 $carom escape --resume a.h5"), "a.h5.part/checkpoint.h5",
                 "/system");
  expect_changed(shell("$carom merge sum.h5 a.h5"), "a.h5.part/checkpoint.h5", "/system");
  EXPECT_TRUE(shell.exists("a.h5.part/checkpoint.h5") && !shell.exists("a.h5") &&
              !shell.exists("sum.h5"));
  // As it was, it goes on.
  change_text(checkpoint, "stem_width = 2", "stem_width = 1");
  const std::string go_on =
      "$carom escape --resume a.h5 --quiet --checkpoint blocks:20 & pid=$!; until_saved a.h5; kill "
      "-9 $pid; wait $pid";
  EXPECT_EQ(shell(go_on).status, 137);
}

TEST(Checksums, AChangedTextOfAnArchiveIsRefused) {
  const Shell shell;
  const std::string lossy =
      " henon-heiles --trajectories 20 --set particles.energy=2 --set integrator.step=0.01 --t-max "
      "100 --quiet ";
  ASSERT_EQ(shell("$carom run mushroom --t-max 3 -o run.h5 --quiet && $carom diffusion "
                  "lorentz-triangular --trajectories 50 --t-max 5 -o d.h5 --quiet")
                .status,
            0);
  ASSERT_EQ(shell("$carom escape" + lossy + "-o lost.h5").status, 3);
  struct Case {
    const char *command, *file, *from, *to, *text;
  };
  const Case cases[] = {
      {"run --resume run.h5 --t-max 5", "run.h5", "stem_width = 1", "stem_width = 2", "/system"},
      {"diffusion --resume d.h5", "d.h5", "shape = ", "shapf = ", "/system"},
      {"escape --resume lost.h5", "lost.h5", "step = 0.01", "step = 0.02", "/system"},
      {"escape --resume lost.h5", "lost.h5", "; unresolved at t", "; unresolvec at t", "/lost"}};
  for (const Case& one : cases) {
    ASSERT_EQ(shell(std::string("cp ") + one.file + " kept").status, 0);
    change_text(shell.folder() + "/" + one.file, one.from, one.to);
    expect_changed(shell(std::string("$carom ") + one.command), one.file, one.text);
    ASSERT_EQ(shell(std::string("mv kept ") + one.file).status, 0);
  }
}

// What a run goes on from, and what it keeps beside what it adds.
TEST(Checksums, ABitOfARunIsToldOf) {
  const Shell shell;
  ASSERT_EQ(
      shell(
          "$carom run stadium --set 'table.hole=[]' --t-max 30 --set run.sample=1 -o a.h5 --quiet")
          .status,
      0);
  for (const char* column :
       {"state/vx", "state/u", "trust/error", "collisions/s", "trajectory/x"}) {
    ASSERT_EQ(shell("cp a.h5 b.h5").status, 0);
    const std::string path = shell.folder() + "/b.h5";
    change_bit_of(path, column);
    EXPECT_FALSE(can_be_read(path, column)) << column;  // by no reader: Fletcher-32
    const Outcome o = shell("$carom run --resume b.h5 --t-max 40 --quiet");
    EXPECT_EQ(o.status, 1) << column;
    EXPECT_NE(o.err.find(std::string("b.h5: '/") + column + "' is missing or not readable"),
              std::string::npos)
        << o.err;
  }
}

TEST(Checksums, ABitOfARecordIsToldOf) {
  const Shell shell;
  ASSERT_EQ(shell("$carom escape stadium --trajectories 2000 --t-max 20 --per-trajectory --shard "
                  "1/2 -o a.h5 --quiet && "
                  "$carom escape stadium --trajectories 2000 --t-max 20 --per-trajectory --shard "
                  "2/2 -o b.h5 --quiet")
                .status,
            0);
  for (const char* column : {"trajectories/x", "trajectories/vy", "trajectories/t"}) {
    ASSERT_EQ(shell("cp a.h5 c.h5").status, 0);
    change_bit_of(shell.folder() + "/c.h5", column);
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
                  "$carom run stadium --precision certified --collisions 40 -o c.h5 --quiet")
                .status,
            0);
  for (const auto& [name, column] : {std::pair{"s.h5", "section/x"}, {"c.h5", "collisions/x"}}) {
    const std::string path = shell.folder() + "/" + name;
    EXPECT_TRUE(can_be_read(path, column)) << name;
    change_bit_of(path, column);
    EXPECT_FALSE(can_be_read(path, column)) << name;
  }
}

// Fletcher-32 takes words of ones for words of zeros.
TEST(Checksums, ZerosThatBecameOnesAreReported) {
  const Shell shell;
  ASSERT_EQ(shell("$carom run stadium --closed --position 0,0 --velocity 0,1 --t-max 30 -o a.h5 "
                  "--quiet")
                .status,
            0);
  const std::string path = shell.folder() + "/a.h5",
                    column = "state/vy";  // 1 or -1
  haddr_t at = 0;
  with_file(path, [&](hid_t file) {
    const hid_t dataset = H5Dopen2(file, column.c_str(), H5P_DEFAULT),
                space = H5Dget_space(dataset);
    hsize_t chunk = 0, bytes = 0;
    unsigned filters = 0;
    EXPECT_GE(H5Dget_chunk_info(dataset, space, 0, &chunk, &filters, &at, &bytes), 0);
    H5Sclose(space);
    H5Dclose(dataset);
  });
  std::fstream(path, std::ios::in | std::ios::out | std::ios::binary)
          .seekp(static_cast<std::streamoff>(at + 2))
      << "\xff\xff";
  EXPECT_TRUE(can_be_read(path, column.c_str()));
  expect_changed(shell("$carom run --resume a.h5 --t-max 40 --quiet"), "a.h5", "/" + column);
}

// Each dataset and attribute has its place in the list.
TEST(Checksums, SwappedRemovedOrChangedDataAreReported) {
  const Shell shell;
  ASSERT_EQ(shell("$carom escape stadium --trajectories 200 --t-max 20 -o a.h5 --quiet").status, 0);
  const auto outcome = [&](const std::function<void(hid_t)>& change) {
    EXPECT_EQ(shell("cp a.h5 b.h5").status, 0);
    with_file(shell.folder() + "/b.h5", change);
    return shell("$carom escape --resume b.h5 --json");
  };
  expect_changed(outcome([](hid_t file) {
                   H5Lmove(file, "fates/pinned", file, "fates/kept", H5P_DEFAULT, H5P_DEFAULT);
                   H5Lmove(file, "fates/escaped", file, "fates/pinned", H5P_DEFAULT, H5P_DEFAULT);
                   H5Lmove(file, "fates/kept", file, "fates/escaped", H5P_DEFAULT, H5P_DEFAULT);
                 }),
                 "b.h5", "/fates/escaped");
  const auto set = [&](const char* object, const char* attribute, const auto& value, hid_t type) {
    return outcome([&](hid_t file) {
      const hid_t owner = H5Oopen(file, object, H5P_DEFAULT),
                  which = H5Aopen(owner, attribute, H5P_DEFAULT);
      EXPECT_GE(H5Awrite(which, type, &value), 0);
      H5Aclose(which);
      H5Oclose(owner);
    });
  };
  expect_changed(set("/provenance", "seconds", 17.0, H5T_NATIVE_DOUBLE), "b.h5",
                 "/provenance@seconds");
  expect_changed(set("/provenance", "lanes_hits", 17, H5T_NATIVE_INT), "b.h5",
                 "/provenance@lanes_hits");
  expect_changed(set("/", "complete", 0, H5T_NATIVE_INT), "b.h5", "/@complete");
  const Outcome removed = outcome([](hid_t file) { H5Ldelete(file, "fates/holes", H5P_DEFAULT); });
  expect_refused(removed, "b.h5: '/fates/holes' ");
  const Outcome none =
      outcome([](hid_t file) { H5Adelete_by_name(file, "provenance", "checksums", H5P_DEFAULT); });
  expect_refused(none, "b.h5: '/provenance@checksums' ");
}

// Notes that a user has added are ignored, whatever their type.
TEST(Checksums, DataOfOtherProgramsAreIgnored) {
  const Shell shell;
  ASSERT_EQ(shell("$carom run sinai --t-max 30 -o a.h5 --quiet").status, 0);
  with_file(shell.folder() + "/a.h5", [](hid_t file) {
    const hid_t text = H5Tcopy(H5T_C_S1), scalar = H5Screate(H5S_SCALAR);
    H5Tset_size(text, H5T_VARIABLE);
    const hid_t note = H5Acreate2(file, "note", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
    const char* words = "the good one";
    EXPECT_GE(H5Awrite(note, text, &words), 0);
    H5Aclose(note);
    const hsize_t size[] = {2, 3};
    const hid_t plane = H5Screate_simple(2, size, nullptr);
    H5Dclose(H5Dcreate2(file, "picture", H5T_NATIVE_DOUBLE, plane, H5P_DEFAULT, H5P_DEFAULT,
                        H5P_DEFAULT));
    H5Sclose(plane);
    // h5py's lzf, which the library does not have.
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE), row = H5Screate_simple(1, size, nullptr);
    H5Pset_chunk(layout, 1, size);
    H5Pset_filter(layout, 32000, H5Z_FLAG_OPTIONAL, 0, nullptr);
    const hid_t packed =
        H5Dcreate2(file, "packed", H5T_NATIVE_INT32, row, H5P_DEFAULT, layout, H5P_DEFAULT);
    const hsize_t first = 0;
    EXPECT_GE(H5Dwrite_chunk(packed, H5P_DEFAULT, 0, &first, 3, "abc"), 0);
    H5Dclose(packed);
    H5Pclose(layout);
    H5Sclose(row);
    H5Sclose(scalar);
    H5Tclose(text);
  });
  for (const char* t : {"40", "50"}) {
    const Outcome o = shell(std::string("$carom run --resume a.h5 --quiet --t-max ") + t);
    EXPECT_EQ(o.status, 0) << o.err;
  }
  with_file(shell.folder() + "/a.h5", [](hid_t file) { EXPECT_GT(H5Aexists(file, "note"), 0); });
}

// Lists of free space hold nothing of the run, and only a writer reads them.
TEST(Checksums, DamagedFreeSpaceIsHarmlessOrNamed) {
  const Shell shell;
  ASSERT_EQ(shell("$carom run sinai --t-max 20 --set run.sample=1 -o kept.h5 --quiet").status, 0);
  const std::string bytes = shell.read("kept.h5");
  int tried = 0;
  for (const std::string signature : {"FSHD", "FSSE"})
    for (std::size_t at = bytes.find(signature); at != std::string::npos;
         at = bytes.find(signature, at + 1)) {
      std::string bad = bytes;
      bad[at + 8] ^= 0x10;
      std::ofstream(shell.folder() + "/a.h5", std::ios::binary) << bad;
      const Outcome o = shell("$carom run --resume a.h5 --t-max 30 --quiet -o b.h5");
      if (o.status != 0) {
        expect_refused(o, "a.h5: a structure of the file is damaged (HDF5: ");
        EXPECT_EQ(shell.files(), (std::vector<std::string>{"a.h5", "kept.h5"}));
      }
      ++tried;
      shell("rm -f b.h5");
    }
  EXPECT_GE(tried, 2);
}

// As a user of Python computes it: the sum of a dataset's bytes, and zlib's function.
TEST(Checksums, AreThoseOfZlib) {
  EXPECT_EQ(files::hdf5::crc32("123456789", 9), 0xcbf43926u);
  const std::string text = "Carom computes the motion of classical particles";
  EXPECT_EQ(
      files::hdf5::crc32(text.data() + 5, text.size() - 5, files::hdf5::crc32(text.data(), 5)),
      files::hdf5::crc32(text.data(), text.size()));
  const Shell shell;
  ASSERT_EQ(shell("$carom run sinai --collisions 5000 -o a.h5 --quiet").status, 0);
  const std::vector<double> times = read_reals(shell.folder() + "/a.h5", "collisions/t");
  char line[80];
  std::snprintf(line, sizeof line, "\n%08x float64 %015zu /collisions/t\n",
                files::hdf5::crc32(times.data(), times.size() * sizeof(double)), times.size());
  EXPECT_NE(shell.read("a.h5").find(line), std::string::npos) << line;
}

// Before anything is computed: what goes on from damaged records would be thrown away in the end.
TEST(Checksums, ABitOfTheRecordsOfACheckpointIsToldOfAtOnce) {
  const Shell shell;
  shell(
      "$carom escape mushroom --trajectories 1e9 --per-trajectory -o a.h5 --quiet --block 4 "
      "--checkpoint blocks:2000 & pid=$!; "
      "until_there a.h5.part/records; until_saved a.h5; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("a.h5.part/checkpoint.h5"));
  // Bytes 8 to 15 of the first record: where the trajectory started.
  double x = 0;
  std::ifstream(shell.folder() + "/a.h5.part/records", std::ios::binary)
      .seekg(8)
      .read(reinterpret_cast<char*>(&x), sizeof x);
  ASSERT_EQ(shell("cp a.h5.part/records kept").status, 0);
  change_last_bit(shell.folder() + "/a.h5.part/records", x);
  const Outcome o = shell("timeout 300 $carom escape --resume a.h5");
  expect_refused(o, "a.h5.part/records: ");
  EXPECT_TRUE(shell.exists("a.h5.part/checkpoint.h5") && shell.exists("a.h5.part/records") &&
              !shell.exists("a.h5"));
  // Mended, they go on.
  const Outcome again = shell(
      "cp kept a.h5.part/records; $carom escape --resume a.h5 --quiet --checkpoint blocks:20 & "
      "pid=$!; until_saved a.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(again.status, 130) << again.err;
}

// Names that are known are found in a damaged index of links, but other readers list it.
TEST(Checksums, AnIndexOfLinksIsDamagedOrLists) {
  const Shell shell;
  ASSERT_EQ(
      shell("$carom run stadium --closed --t-max 60 --set run.sample=0.5 -o a.h5 --quiet").status,
      0);
  const std::string path = shell.folder() + "/a.h5", whole = shell.read("a.h5");
  const auto lists = [](hid_t file) {
    const auto nothing = [](hid_t, const char*, const H5O_info_t*, void*) -> herr_t { return 0; };
    return H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, nothing, nullptr, H5O_INFO_BASIC) >= 0;
  };
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  int refused_for_links = 0;
  // Every eighth byte with CAROM_SOAK.
  const std::size_t step = tests::soak() ? 8 : 24;
  for (std::size_t at = 0; at < std::min<std::size_t>(whole.size(), 8192); at += step) {
    std::string bad = whole;
    bad[at] ^= 16;
    std::ofstream(path, std::ios::binary) << bad;
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) continue;
    try {
      files::hdf5::verify(file, path);
      EXPECT_TRUE(lists(file)) << at;
    } catch (const InputError& error) {
      refused_for_links += error.problem().find("index of links") != std::string::npos;
    }
    H5Fclose(file);
  }
  EXPECT_GT(refused_for_links, 0);
}

}  // namespace
}  // namespace carom
