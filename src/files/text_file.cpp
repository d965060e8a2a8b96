#include "files/text_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace carom::files {
namespace {

class Descriptor {
 public:
  // Without waiting: a named pipe opens although nothing writes to it.
  explicit Descriptor(const std::string& name)
      : number_(::open(name.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  Descriptor(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int get() const { return number_; }

  /// Is there something to read, or an end, within `milliseconds`? -1: waits for it.
  void wait(int milliseconds) const {
    pollfd watched{number_, POLLIN, 0};
    ::poll(&watched, 1, milliseconds);
  }

 private:
  int number_;
};

}  // namespace

std::string text_of_file(const std::string& name, std::size_t most, const Place& place,
                         const std::string& subject, const std::string& expected) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(place, subject + "cannot be read: " + why, expected);
  };
  const Descriptor file(name);
  struct stat about {};
  if (file.get() < 0 || ::fstat(file.get(), &about) != 0) refuse(std::strerror(errno));
  if (S_ISDIR(about.st_mode)) throw InputError(place, subject + "is a folder", expected);
  constexpr int patience = 1000;  // ms
  if (S_ISFIFO(about.st_mode)) file.wait(patience);
  std::string text;
  for (std::size_t size = 0;;) {
    constexpr std::size_t batch = std::size_t{1} << 20;
    if (size > most) throw too_long(place, most, subject, expected);
    text.resize(size + batch);
    const ssize_t got = ::read(file.get(), text.data() + size, batch);
    text.resize(size += static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0) return text;
    if (got > 0 || errno == EINTR) continue;
    if (errno != EAGAIN) refuse(std::strerror(errno));
    file.wait(-1);
  }
}

}  // namespace carom::files
