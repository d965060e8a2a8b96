// carom plot, carom animate: the picture or the film of an archive or a system.
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "carom/base/error.hpp"
#include "carom_version.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/picture.hpp"

namespace carom::cli {

namespace {

// Draws, and says what was made.
int drawn(const Options& options, const char* kind, const std::string& file) {
  std::vector<std::string> words;
  for (const auto& [name, text] : {std::pair{"what", &options.what},
                                   {"frames", &options.frames},
                                   {"fps", &options.fps},
                                   {"trail", &options.trail}})
    if (!text->empty()) words.push_back(fmt::format("--{}={}", name, *text));
  const int status = draw(options.system, file, options.force, words);
  if (status != done) return status;
  if (!options.json) {
    print(fmt::format("{}: {}\n", kind, file));
    return done;
  }
  files::Json json = files::Json::object();
  json.set("version", version).set("system", options.system).set("kind", kind).set("file", file);
  if (!options.what.empty()) json.set("what", options.what);
  print(json.text() + "\n");
  return done;
}

std::string name_of(const std::string& source) {
  return std::filesystem::path(source).stem().string();
}

}  // namespace

int animate(const Options& options) {
  std::string film = options.output;
  if (film.empty()) film = name_of(options.system) + ".gif";
  if (!film.ends_with(".gif") && !film.ends_with(".mp4"))
    throw InputError(Place{"command line", 0, 0, "-o"}, "'" + film + "' is not a film",
                     "a name ending in .gif or .mp4");
  return drawn(options, "film", film);
}

int plot(const Options& options) {
  std::string picture = options.output;
  if (picture.empty())
    picture = name_of(options.system) + (options.what.empty() ? "" : "-" + options.what) + ".png";
  refuse_other_endings(picture);
  return drawn(options, "picture", picture);
}

}  // namespace carom::cli
