// carom page: the page that computes in a browser.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>

#include "carom/base/error.hpp"
#include "carom_version.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "files/platform.hpp"

extern char** environ;

namespace carom::cli {

namespace {

constexpr auto npos = std::string::npos;

// Seen from the program: in a build, or where both are installed.
std::filesystem::path find_page() {
  const std::filesystem::path folder =
      std::filesystem::path(files::path_of_program()).parent_path();
  for (const char* place : {"../page/carom.html", "../share/carom/carom.html"})
    if (const auto page = (folder / place).lexically_normal(); std::filesystem::exists(page))
      return page;
  throw InputError(Place{}, "the page is not there", "./dev page, which makes it");
}

// Deflate (RFC 1951) without compression: blocks of at most 65535 bytes as they are.
std::string stored(std::string_view text) {
  std::string all;
  do {
    const std::string_view block = text.substr(0, 65535);
    text.remove_prefix(block.size());
    const auto size = static_cast<unsigned>(block.size());
    all += text.empty() ? '\1' : '\0';
    for (const unsigned byte : {size, size >> 8, ~size, ~size >> 8})
      all += static_cast<char>(byte & 0xff);
    all += block;
  } while (!text.empty());
  return all;
}

// For addresses (RFC 4648, 5), without padding.
std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k <= count; ++k) text += digits[three >> (18 - 6 * k) & 63];
  }
  return text;
}

// By whatever the desktop opens pages with; where there is none, the address is enough.
void open(const std::string& address) {
  for (const char* opener : {"xdg-open", "open"}) {
    char* const words[] = {const_cast<char*>(opener), const_cast<char*>(address.c_str()), nullptr};
    pid_t child = 0;
    if (::posix_spawnp(&child, opener, nullptr, nullptr, words, environ) != 0) continue;
    ::waitpid(child, nullptr, 0);
    return;
  }
}

}  // namespace

int page(const Options& options) {
  std::string address = "file://" + find_page().string();
  if (!options.system.empty()) {
    const LoadedSystem loaded = system_of_command(options);
    const bool changed = !options.overrides.set.empty() || options.system.find('/') != npos ||
                         options.system.ends_with(".toml");
    address +=
        changed ? "#toml=" + base64(stored(loaded.resolved_toml)) : "#system=" + options.system;
  }
  if (options.json) {
    files::Json json = files::Json::object();
    json.set("version", version).set("page", address);
    print(json.text() + "\n");
    return done;
  }
  print(address + "\n");
  if (::isatty(STDOUT_FILENO) != 0) open(address);
  return done;
}

}  // namespace carom::cli
