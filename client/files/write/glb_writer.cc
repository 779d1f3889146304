// glTF 2.0 (Khronos Group, 2021), section 4.4 "GLB File Format": a header of 12 bytes, a chunk of JSON, a chunk of arrays.
#include "client/files/write/glb_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/coding.h"
#include "client/base/error.h"
#include "client/text/printable.h"

namespace affskel::client {
namespace {

using core::Vec3;
using nlohmann::ordered_json;

constexpr int kFloat = 5126, kUint16 = 5123, kUint32 = 5125;  // component types
constexpr int kVertices = 34962, kIndices = 34963;            // what a view of the buffer is for
constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

// The arrays, each at a multiple of 4 bytes, and what describes them.
class GlbArrays {
 public:
  // @returns the number of its accessor.
  std::size_t add(const std::string& bytes, std::size_t count, int component, const char* type, int target) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    if (target != 0) views_.back()["target"] = target;
    accessors_.push_back(
        {{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    bytes_ += bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    return accessors_.size() - 1;
  }

  ordered_json& last() { return accessors_.back(); }
  const ordered_json& views() const { return views_; }
  const ordered_json& accessors() const { return accessors_; }
  const std::string& bytes() const { return bytes_; }

 private:
  ordered_json views_ = ordered_json::array(), accessors_ = ordered_json::array();
  std::string bytes_;
};

class GlbWriter {
 public:
  explicit GlbWriter(const LimbedSurface& solid) : solid_(solid), armature_(make_armature(solid)) {
    low_ = high_ = solid.surface.points.front();
    for (const Vec3& p : solid.surface.points) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
    }
    centre_ = 0.5 * (low_ + high_);
  }

  void run(const std::vector<std::string>& comments, const WriteBytes& write) {
    add_surface();
    add_joints();
    file_["asset"] = {{"version", "2.0"}, {"generator", "affskel-client"}};
    for (const std::string& comment : comments)
      file_["asset"]["extras"]["about"].push_back(one_line(comment));
    file_["scene"] = 0;
    file_["scenes"] = {{{"nodes", {0}}}};
    file_["bufferViews"] = arrays_.views();
    file_["accessors"] = arrays_.accessors();
    file_["buffers"] = {{{"byteLength", arrays_.bytes().size()}}};
    std::string json = file_.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    write_chunks(json, write);
  }

 private:
  void write_chunks(const std::string& json, const WriteBytes& write) const {
    const std::size_t length = 12 + 8 + json.size() + 8 + arrays_.bytes().size();
    if (length > std::numeric_limits<std::uint32_t>::max())
      throw ClientError(ExitCode::kLimit, "the solid has too many triangles for .glb, which holds 4 GB");
    std::string head;
    for (const std::uint32_t word :
         {kMagic, 2U, static_cast<std::uint32_t>(length), static_cast<std::uint32_t>(json.size()), kJson})
      base::append(head, word);
    write(head);
    write(json);
    head.clear();
    base::append(head, static_cast<std::uint32_t>(arrays_.bytes().size()));
    base::append(head, kBinary);
    write(head);
    write(arrays_.bytes());
  }

  static void append(std::string& bytes, const Vec3& v) {
    for (int c = 0; c < 3; ++c) base::append(bytes, static_cast<float>(v[c]));
  }

  void add_surface() {
    const auto& [points, triangles] = solid_.surface;
    std::string places, corners, joints, weights;
    for (const Vec3& point : points) append(places, point - centre_);
    for (const core::Triangle& triangle : triangles)
      for (const std::uint32_t v : triangle) base::append(corners, v);
    for (const Binding& binding : armature_.bindings) {
      const bool two = binding.share < 1;
      for (const std::uint32_t joint : {binding.joint[0], two ? binding.joint[1] : 0U, 0U, 0U})
        base::append(joints, static_cast<std::uint16_t>(joint));
      const auto share = static_cast<float>(binding.share);
      for (const float weight : {share, 1 - share, 0.0F, 0.0F}) base::append(weights, weight);
    }
    ordered_json attributes;
    attributes["POSITION"] = arrays_.add(places, points.size(), kFloat, "VEC3", kVertices);
    const Vec3 half = high_ - centre_, other = low_ - centre_;
    const auto single = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    arrays_.last()["min"] = {single(other.x), single(other.y), single(other.z)};
    arrays_.last()["max"] = {single(half.x), single(half.y), single(half.z)};
    attributes["JOINTS_0"] = arrays_.add(joints, points.size(), kUint16, "VEC4", kVertices);
    attributes["WEIGHTS_0"] = arrays_.add(weights, points.size(), kFloat, "VEC4", kVertices);
    const std::size_t indices = arrays_.add(corners, 3 * triangles.size(), kUint32, "SCALAR", kIndices);
    file_["meshes"] = {
        {{"name", "solid"}, {"primitives", {{{"attributes", attributes}, {"indices", indices}}}}}};
  }

  // Node 0 turns z up, node 1 is the mesh, the joints follow.
  void add_joints() {
    constexpr std::size_t kFirst = 2;
    const double half_turn = std::sqrt(0.5);
    ordered_json nodes = ordered_json::array();
    nodes.push_back({{"name", "affine skeleton"},
                     {"rotation", {-half_turn, 0, 0, half_turn}},
                     {"translation", {centre_.x, centre_.z, -centre_.y}},
                     {"children", {1}}});
    nodes.push_back({{"name", "solid"}, {"mesh", 0}, {"skin", 0}});
    ordered_json numbers = ordered_json::array();
    std::string inverse;
    for (std::size_t j = 0; j < armature_.joints.size(); ++j) {
      const Joint& joint = armature_.joints[j];
      const bool root = joint.parent == Joint::kNone;
      const Vec3 at = joint.place - (root ? centre_ : armature_.joints[joint.parent].place);
      nodes.push_back(
          {{"name", "part " + std::to_string(joint.part + 1) + "." + std::to_string(joint.number)},
           {"translation", {at.x, at.y, at.z}}});
      nodes[root ? 0 : kFirst + joint.parent]["children"].push_back(kFirst + j);
      numbers.push_back(kFirst + j);
      const Vec3 back = centre_ - joint.place;
      for (const double entry : {1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., back.x, back.y, back.z, 1.})
        base::append(inverse, static_cast<float>(entry));
    }
    file_["nodes"] = nodes;
    file_["skins"] = {
        {{"joints", numbers},
         {"inverseBindMatrices", arrays_.add(inverse, armature_.joints.size(), kFloat, "MAT4", 0)}}};
  }

  const LimbedSurface& solid_;
  const Armature armature_;
  Vec3 low_, high_, centre_;
  GlbArrays arrays_;
  ordered_json file_;
};

}  // namespace

void write_glb(const LimbedSurface& solid, const std::vector<std::string>& comments,
               const WriteBytes& write) {
  GlbWriter(solid).run(comments, write);
}

}  // namespace affskel::client
