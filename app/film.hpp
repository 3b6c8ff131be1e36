// The pictures of a run: a PNG per frame, an animated WebP, and an MP4 where ffmpeg is.
#pragma once

#include <filesystem>

#include "app/command.hpp"
#include "core/scene/scene.hpp"
#include "core/simulate/simulation.hpp"
#include "render/gl/context.hpp"

namespace unfurl {

// How many frames a run to the scene's end time would have at most; throws SceneError where that is beyond
// reason.
void check_film(const Scene& scene);

// Writes DIR/frames/frame_00000.png ..., DIR/animation.webp and, where ffmpeg is, DIR/animation.mp4. Stops at
// Ctrl-C and keeps what is finished. Returns whether all frames were drawn. Throws FileError, GraphicsError.
bool write_film(const std::filesystem::path& directory, const Scene& scene, const Simulation& run,
                GlContext& context, const Arguments& arguments);

}  // namespace unfurl
