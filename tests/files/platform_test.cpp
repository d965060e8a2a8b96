// What systems do each in their own way: on Linux both halves.
#include "files/platform.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "../scratch_folder.hpp"

namespace carom {

using namespace files;

namespace {

constexpr int unknown = 0x7fff;  // no command of fcntl

std::string told;
int calls = 0;
int tell(char* path, std::uint32_t* size) {
  ++calls;
  if (*size <= told.size()) {
    *size = static_cast<std::uint32_t>(told.size() + 1);
    return -1;
  }
  std::memcpy(path, told.c_str(), told.size() + 1);
  return 0;
}

TEST(Platform, KnowsTheProgram) {
  EXPECT_EQ(path_of_program().filename(), "test_files");
  told = path_of_program().string();
  EXPECT_EQ(portable::path_of_program(tell), path_of_program());
}

TEST(Platform, AsksAgainForALongPath) {
  const std::string program = path_of_program().string();
  const std::size_t name = program.rfind('/') + 1;
  told = program.substr(0, name);
  while (told.size() < 600) told += "./";
  told += program.substr(name);
  calls = 0;
  EXPECT_EQ(portable::path_of_program(tell), path_of_program());
  EXPECT_EQ(calls, 2);
  told = "/no/such/file";
  EXPECT_EQ(portable::path_of_program(tell), "");
}

TEST(Platform, SyncsByWhatThereIs) {
  const ScratchFolder folder;
  const int file = open(folder.file("synced").c_str(), O_CREAT | O_RDWR, 0600);
  ASSERT_GE(file, 0);
  EXPECT_TRUE(sync_contents(file));
  EXPECT_TRUE(sync_all(file));
  EXPECT_TRUE(portable::sync(file, unknown));
  close(file);
  for (const bool synced : {sync_contents(file), sync_all(file), portable::sync(file, unknown)}) {
    EXPECT_FALSE(synced);
    EXPECT_EQ(errno, EBADF);
  }
}

}  // namespace
}  // namespace carom
