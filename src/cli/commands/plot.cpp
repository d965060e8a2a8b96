// carom plot, carom animate: the picture or the film of an archive or a system.
#include <filesystem>

#include "carom/base/error.hpp"
#include "cli/commands/commands.hpp"
#include "cli/picture.hpp"

namespace carom::cli {

int animate(const Options& options) {
  std::string film = options.output;
  if (film.empty()) film = std::filesystem::path(options.system).stem().string() + ".gif";
  if (!film.ends_with(".gif") && !film.ends_with(".mp4"))
    throw InputError(Place{"command line", 0, 0, "-o"}, "'" + film + "' is not a film",
                     "a name ending in .gif or .mp4");
  return draw(options.system, film, options.force);
}

int plot(const Options& options) {
  std::string picture = options.output;
  if (picture.empty()) picture = std::filesystem::path(options.system).stem().string() + ".png";
  if (!is_picture(picture))
    throw InputError(Place{"command line", 0, 0, "-o"}, "'" + picture + "' is not a picture",
                     "a name ending in .png, .svg or .pdf");
  return draw(options.system, picture, options.force, options.what);
}

}  // namespace carom::cli
