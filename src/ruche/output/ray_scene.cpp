#include "ruche/output/ray_scene.hpp"

#include <embree3/rtcore.h>

#include <stdexcept>

namespace ruche {

struct RayScene::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

namespace {

template <class Row>
Row* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
    return static_cast<Row*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Row), count));
}

void attach(RTCDevice device, RTCScene scene, const Relief& part, unsigned id) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = new_buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                                      part.positions.size());
    auto* indices = new_buffer<std::array<unsigned, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                                        part.triangles.size());
    if (vertices == nullptr || indices == nullptr) {
        rtcReleaseGeometry(geometry);
        throw std::runtime_error("not enough memory for the picture");
    }
    for (std::size_t v = 0; v < part.positions.size(); ++v)
        for (int i = 0; i < 3; ++i) vertices[v][i] = static_cast<float>(part.positions[v][i]);
    for (std::size_t t = 0; t < part.triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) indices[t][i] = static_cast<unsigned>(part.triangles[t][i]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

RTCRay embree_ray(const Ray& ray) {
    RTCRay result = {};
    result.org_x = ray.origin.x();
    result.org_y = ray.origin.y();
    result.org_z = ray.origin.z();
    result.dir_x = ray.direction.x();
    result.dir_y = ray.direction.y();
    result.dir_z = ray.direction.z();
    result.tnear = ray.begin;
    result.tfar = ray.end;
    result.mask = ~0U;
    return result;
}

}  // namespace

RayScene::RayScene(std::vector<Relief> parts)
    : parts_(std::move(parts)), handles_(std::make_unique<Handles>()) {
    // One building thread: the tree, and so which of two equally near triangles is met, is always the same.
    handles_->device = rtcNewDevice("threads=1");
    if (handles_->device == nullptr) throw std::runtime_error("cannot start the ray caster (Embree)");
    handles_->scene = rtcNewScene(handles_->device);
    rtcSetSceneFlags(handles_->scene, RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (!parts_[i].triangles.empty())
            attach(handles_->device, handles_->scene, parts_[i], static_cast<unsigned>(i));
    rtcCommitScene(handles_->scene);
}

RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

bool RayScene::intersect(const Ray& ray, RayHit& hit) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query = {};
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(handles_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit = {query.ray.tfar, static_cast<int>(query.hit.geomID), static_cast<int>(query.hit.primID),
           query.hit.u, query.hit.v};
    return true;
}

bool RayScene::occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = embree_ray(ray);
    rtcOccluded1(handles_->scene, &context, &query);
    return query.tfar < 0.0F;  // Embree's way of saying yes
}

}  // namespace ruche
