#include "files/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace carom::files {

Progress::Progress(bool wanted, double done)
    : enabled_(wanted && isatty(STDERR_FILENO) != 0),
      done_(done),
      start_(Clock::now()),
      last_(start_) {
  if (enabled_) clock_ = std::thread([this] { tell_time(); });
}

Progress::~Progress() {
  if (enabled_) {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    end_.notify_all();
    clock_.join();
  }
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::count(std::uint64_t done, std::uint64_t all, const char* name) {
  if (!due()) return;
  show(static_cast<double>(done) / static_cast<double>(all),
       with_prefix(static_cast<double>(done) / seconds()) + name + "/s");
}

bool Progress::due() const {
  return enabled_ && Clock::now() - last_ >= std::chrono::milliseconds(200);
}

double Progress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::show(double share, const std::string& rate) {
  if (!enabled_) return;
  const std::lock_guard lock(mutex_);
  last_ = Clock::now();
  shown_ = true;
  const double left = seconds_left(seconds(), done_, share);
  line_ = fmt::format("\r{:5.1f} %  {}  {}", 100.0 * share, rate,
                      left > 0.0 ? as_duration(left) + " left" : std::string());
  std::fputs((line_ + "\033[K").c_str(), stderr);
  std::fflush(stderr);
}

void Progress::tell_time() {
  constexpr std::chrono::seconds interval(2);
  std::unique_lock lock(mutex_);
  while (!end_.wait_for(lock, interval, [this] { return ended_; })) {
    if (Clock::now() - last_ < interval) continue;
    shown_ = true;
    std::fputs(fmt::format("{}  {} so far\033[K", line_, as_duration(seconds())).c_str(), stderr);
    std::fflush(stderr);
  }
}

double seconds_left(double seconds, double from, double share) {
  return share > from && share < 1.0 ? seconds * (1.0 - share) / (share - from) : -1.0;
}

std::string with_prefix(double value) {
  static constexpr const char* prefixes[] = {"", "k", "M", "G", "T"};
  std::size_t i = 0;
  while (i + 1 < std::size(prefixes) && std::abs(value) >= 999.5) {
    value /= 1000.0;
    ++i;
  }
  const int decimals = i == 0 || value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f} {}", value, decimals, prefixes[i]);
}

std::string as_duration(double seconds) {
  const double whole = std::ceil(seconds);
  if (!(whole < 1e12)) return "ages";
  const auto s = static_cast<long long>(whole);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s / 60 % 60);
}

}  // namespace carom::files
