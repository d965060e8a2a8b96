// One writer at a time, also while others let go.
#include "io/file_lock.hpp"

#include <gtest/gtest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/io/archive.hpp"
#include "scratch_folder.hpp"

namespace carom {
namespace {

TEST(FileLock, RefusesTheSecondAndLeavesNothing) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  {
    const ArchiveLock first = lock_archive(file);
    EXPECT_THROW(lock_archive(file), InputError);
    EXPECT_TRUE(std::filesystem::exists(file + ".lock"));
  }
  EXPECT_FALSE(std::filesystem::exists(file + ".lock"));
  EXPECT_NO_THROW(lock_archive(file));
}

// Whoever writes what stands beside an archive keeps others from it, and is kept from it by them.
TEST(FileLock, OfAnArchiveIsThatOfTheFilesBesideIt) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  const std::vector<std::string> beside = {".part", ".part.new", ".records", ".new", ".part.part"};
  for (const std::string& mark : beside) {
    {
      const ArchiveLock first = lock_archive(file);
      EXPECT_THROW(lock_archive(file + mark), InputError) << mark;
    }
    {
      const ArchiveLock first = lock_archive(file + mark);
      EXPECT_THROW(lock_archive(file), InputError) << mark;
      EXPECT_NO_THROW(lock_archive(file + "2" + mark)) << mark;
    }
    EXPECT_NO_THROW(lock_archive(file)) << mark;
  }
  EXPECT_THROW(lock_archive(file + ".lock"), InputError);
  // Two beside the same archive, which is free again only after both.
  ArchiveLock part = lock_archive(file + ".part"), records = lock_archive(file + ".records");
  part.reset();
  EXPECT_THROW(lock_archive(file), InputError);
  records.reset();
  for (const std::string mark : {"", ".part", ".records", ".lock"}) EXPECT_FALSE(std::filesystem::exists(file + mark + ".lock"));
  EXPECT_NO_THROW(lock_archive(file));
}

// Whoever may only read the lock's file, as that of another user, is refused like anybody.
TEST(FileLock, OfAnotherUserCounts) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  const ArchiveLock first = lock_archive(file);
  ASSERT_EQ(::chmod((file + ".lock").c_str(), 0444), 0);
  const bool root = ::geteuid() == 0;  // to whom everything is open
  if (root && ::seteuid(65534) != 0) GTEST_SKIP() << "no right to be another user";
  const bool reached = ::faccessat(AT_FDCWD, folder.path().c_str(), W_OK | X_OK, AT_EACCESS) == 0;
  if (reached) {
    EXPECT_THROW(lock_archive(file), InputError);
  }
  ASSERT_TRUE(!root || ::seteuid(0) == 0);
  if (!reached) GTEST_SKIP() << "another user does not reach the folder of temporary files";
}

// Threads stand for processes: a lock belongs to an open file.
TEST(FileLock, IsHeldByOneWhileTheOthersLetGo) {
  const ScratchFolder folder;
  const std::string file = folder.file("a");
  std::atomic<int> inside{0}, most{0}, held{0};
  const auto work = [&] {
    for (int i = 0; i < 3000; ++i) {
      try {
        const FileLock lock(i % 3 == 0 ? file + ".part" : file);  // alone, or beside it and alone there
        const int now = ++inside;
        if (now > most) most = now;
        ++held;
        std::this_thread::sleep_for(std::chrono::microseconds(i % 3 * 30));
        --inside;
      } catch (const InputError&) {
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(most, 1);
  EXPECT_GT(held, 100);
}

}  // namespace
}  // namespace carom
