// carom plot, carom animate: the picture or the film of an archive or a system.
#include <filesystem>

#include "carom/base/error.hpp"
#include "carom_version.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/picture.hpp"

namespace carom::cli {

namespace {

// Draws, and says with --json what was made.
int drawn(const Options& options, const char* kind, const std::string& file) {
  const int status = draw(options.system, file, options.force, options.what);
  if (status != done || !options.json) return status;
  files::Json json = files::Json::object();
  json.set("version", version).set("system", options.system).set("kind", kind).set("file", file);
  if (!options.what.empty()) json.set("what", options.what);
  print(json.text() + "\n");
  return done;
}

}  // namespace

int animate(const Options& options) {
  std::string film = options.output;
  if (film.empty()) film = std::filesystem::path(options.system).stem().string() + ".gif";
  if (!film.ends_with(".gif") && !film.ends_with(".mp4"))
    throw InputError(Place{"command line", 0, 0, "-o"}, "'" + film + "' is not a film",
                     "a name ending in .gif or .mp4");
  return drawn(options, "film", film);
}

int plot(const Options& options) {
  std::string picture = options.output;
  if (picture.empty()) picture = std::filesystem::path(options.system).stem().string() + ".png";
  refuse_other_endings(picture);
  return drawn(options, "picture", picture);
}

}  // namespace carom::cli
