// carom plot: the picture of an archive or a system.
#include <filesystem>

#include "carom/base/error.hpp"
#include "cli/commands/commands.hpp"
#include "cli/picture.hpp"

namespace carom::cli {

int plot(const Options& options) {
  std::string picture = options.output;
  if (picture.empty()) picture = std::filesystem::path(options.system).stem().string() + ".png";
  if (!is_picture(picture))
    throw InputError(Place{"command line", 0, 0, "-o"}, "'" + picture + "' is not a picture",
                     "a name ending in .png, .svg or .pdf");
  return draw(options.system, picture, options.force);
}

}  // namespace carom::cli
