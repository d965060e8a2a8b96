// One writer at a time, also while others let go.
#include "files/checkpoint/work_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "scratch_folder.hpp"

namespace carom {

using namespace files;

namespace {

TEST(WorkFolder, RefusesTheSecondAndLeavesNothing) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  {
    const ArchiveLock first = lock_archive(file);
    EXPECT_THROW(lock_archive(file), InputError);
    EXPECT_TRUE(std::filesystem::exists(folder_of(file)));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_of(file)));
  EXPECT_NO_THROW(lock_archive(file));
}

// A checkpoint stays, and the folder with it; then it may be claimed again.
TEST(WorkFolder, StaysWithACheckpoint) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  for (int i = 0; i < 2; ++i) {
    const ArchiveLock lock = lock_archive(file);
    for (const std::string& name : {checkpoint_of(file), records_of(file), aside_of(file)})
      std::ofstream(name) << "x";
  }
  EXPECT_TRUE(exists(checkpoint_of(file)) && exists(records_of(file)) && !exists(aside_of(file)));
  EXPECT_TRUE(has_checkpoint(file));
  {
    const ArchiveLock lock = lock_archive(file);
    remove_checkpoint(file);
  }
  EXPECT_FALSE(exists(folder_of(file)));
}

// A process that may only read the lock's file, as that of another user, is refused, too.
TEST(WorkFolder, TheFolderOfAnotherUserCounts) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  const ArchiveLock first = lock_archive(file);
  ASSERT_EQ(::chmod((folder_of(file) + "/carom.lock").c_str(), 0444), 0);
  std::filesystem::permissions(folder_of(file), std::filesystem::perms::all);
  const bool root = ::geteuid() == 0;  // root may open everything
  if (root && ::seteuid(65534) != 0) GTEST_SKIP() << "no right to be another user";
  const bool reached = ::faccessat(AT_FDCWD, folder.path().c_str(), W_OK | X_OK, AT_EACCESS) == 0;
  if (reached) {
    EXPECT_THROW(lock_archive(file), InputError);
  }
  ASSERT_TRUE(!root || ::seteuid(0) == 0);
  if (!reached) GTEST_SKIP() << "another user does not reach the folder of temporary files";
}

// Threads stand for processes: a lock belongs to an open file.
TEST(WorkFolder, IsHeldByOneWhileTheOthersLetGo) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  std::atomic<int> inside{0}, most{0}, others{0};
  const auto work = [&] {
    for (int held = 0; held < 300;) {
      try {
        const WorkFolder claim(file);
        const int now = ++inside;
        if (now > most) most = now;
        std::this_thread::sleep_for(std::chrono::microseconds(held++ % 3 * 30));
        --inside;
      } catch (const InputError& error) {
        others += error.place().file != file;  // the folder is none of Carom's, or cannot be made
        std::this_thread::yield();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(most, 1);
  EXPECT_EQ(others, 0);
  EXPECT_FALSE(exists(folder_of(file)));
}

}  // namespace
}  // namespace carom
