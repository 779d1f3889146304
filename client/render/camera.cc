#include "client/render/camera.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/number_text.h"
#include "client/base/error.h"

namespace affskel::client {
namespace {

using core::Vec3;

struct NamedCamera {
  const char* name;
  double azimuth, elevation;
};

constexpr std::array<NamedCamera, 7> kNamed = {{{"front", 0, 0},
                                                {"side", 90, 0},
                                                {"back", 180, 0},
                                                {"left", 270, 0},
                                                {"top", 0, 90},
                                                {"bottom", 0, -90},
                                                {"oblique", 30, 20}}};

// The point of the unit circle at an angle, exact in multiples of 90 degrees.
struct OnCircle {
  double cosine, sine;
};

OnCircle on_circle(double degrees) {
  const double turned = std::fmod(std::fmod(degrees, 360) + 360, 360);
  const int quarter = static_cast<int>(turned / 90) % 4;
  const double rest = (turned - 90.0 * quarter) * std::numbers::pi / 180;
  const double c = std::cos(rest), s = std::sin(rest);
  const std::array<OnCircle, 4> quarters = {{{c, s}, {-s, c}, {-c, -s}, {s, -c}}};
  return quarters[static_cast<std::size_t>(quarter)];
}

[[noreturn]] void no_camera(std::string_view text) {
  throw ClientError(ExitCode::kUsage, "camera '" + std::string(text) + "': " + camera_words() +
                                          ", or AZIMUTH,ELEVATION in degrees, the elevation from -90 to 90");
}

// Reads all of `text`. @return whether it is a finite number.
bool read_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

}  // namespace

std::string camera_words() {
  std::string words;
  for (std::size_t c = 0; c < kNamed.size(); ++c)
    words += (c == 0 ? "" : c + 1 == kNamed.size() ? " or " : ", ") + std::string(kNamed[c].name);
  return words;
}

Camera parse_camera(std::string_view text) {
  for (const NamedCamera& named : kNamed) {
    if (text == named.name) return {named.name, named.azimuth, named.elevation};
  }
  const std::size_t comma = text.find(',');
  Camera camera;
  if (comma == std::string_view::npos || !read_number(text.substr(0, comma), camera.azimuth) ||
      !read_number(text.substr(comma + 1), camera.elevation) || std::fabs(camera.elevation) > 90) {
    no_camera(text);
  }
  camera.name =
      "azimuth " + base::rounded(camera.azimuth, 4) + ", elevation " + base::rounded(camera.elevation, 4);
  return camera;
}

std::vector<Camera> usual_cameras() {
  return {parse_camera("front"), parse_camera("side"), parse_camera("top")};
}

View view_of(const Camera& camera, const core::Stance& stance) {
  const OnCircle a = on_circle(camera.azimuth), e = on_circle(camera.elevation);
  const Vec3 right = stance.right(), up = stance.up.vector(), front = stance.front.vector();
  const Vec3 level = a.cosine * front + a.sine * right;  // where it looks from, at the horizon
  return {a.cosine * right - a.sine * front, e.cosine * up - e.sine * level, e.cosine * level + e.sine * up};
}

}  // namespace affskel::client
