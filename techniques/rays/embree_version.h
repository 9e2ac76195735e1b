// The differences between Embree 3 and Embree 4, and nothing else. Embree 4 renamed the query context and removed the
// ray streams; there, a stream of packets is asked packet by packet. Internal to this folder.
//
// occluded_*: tfar of a blocked ray becomes minus infinity. occluded_stream: lanes with tfar < tnear are not asked.
#pragma once

#include <cstddef>
#include <string>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#if SIGHTLINES_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#pragma GCC diagnostic pop

namespace sightlines {

/// "3.13.5"
inline std::string embree_release() { return RTC_VERSION_STRING; }

/// What a query carries beside its rays. `coherent`: neighbouring rays of a packet go the same way.
struct EmbreeQuery {
    explicit EmbreeQuery(bool coherent);
    EmbreeQuery(const EmbreeQuery&) = delete;
    EmbreeQuery& operator=(const EmbreeQuery&) = delete;
#if SIGHTLINES_EMBREE_MAJOR >= 4
    mutable RTCRayQueryContext context{};
    mutable RTCIntersectArguments intersect{};
    mutable RTCOccludedArguments occluded{};
#else
    mutable RTCIntersectContext context{};
#endif
};

#if SIGHTLINES_EMBREE_MAJOR >= 4

inline EmbreeQuery::EmbreeQuery(bool coherent) {
    const RTCRayQueryFlags flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    rtcInitRayQueryContext(&context);
    rtcInitIntersectArguments(&intersect);
    rtcInitOccludedArguments(&occluded);
    intersect.flags = occluded.flags = flags;
    intersect.context = occluded.context = &context;
}

inline void intersect_1(RTCScene scene, const EmbreeQuery& query, RTCRayHit& ray) {
    rtcIntersect1(scene, &ray, &query.intersect);
}
inline void intersect_16(const int* valid, RTCScene scene, const EmbreeQuery& query, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &rays, &query.intersect);
}
inline void occluded_1(RTCScene scene, const EmbreeQuery& query, RTCRay& ray) {
    rtcOccluded1(scene, &ray, &query.occluded);
}
inline void occluded_8(const int* valid, RTCScene scene, const EmbreeQuery& query, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &rays, &query.occluded);
}
inline void occluded_16(const int* valid, RTCScene scene, const EmbreeQuery& query, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &rays, &query.occluded);
}
inline void occluded_stream(RTCScene scene, const EmbreeQuery& query, RTCRay16* packets, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
        alignas(64) int valid[16];
        for (int lane = 0; lane < 16; ++lane) valid[lane] = packets[i].tnear[lane] <= packets[i].tfar[lane] ? -1 : 0;
        rtcOccluded16(valid, scene, &packets[i], &query.occluded);
    }
}

#else

inline EmbreeQuery::EmbreeQuery(bool coherent) {
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
}

inline void intersect_1(RTCScene scene, const EmbreeQuery& query, RTCRayHit& ray) {
    rtcIntersect1(scene, &query.context, &ray);
}
inline void intersect_16(const int* valid, RTCScene scene, const EmbreeQuery& query, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &query.context, &rays);
}
inline void occluded_1(RTCScene scene, const EmbreeQuery& query, RTCRay& ray) {
    rtcOccluded1(scene, &query.context, &ray);
}
inline void occluded_8(const int* valid, RTCScene scene, const EmbreeQuery& query, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &query.context, &rays);
}
inline void occluded_16(const int* valid, RTCScene scene, const EmbreeQuery& query, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &query.context, &rays);
}
inline void occluded_stream(RTCScene scene, const EmbreeQuery& query, RTCRay16* packets, unsigned count) {
    rtcOccludedNM(scene, &query.context, reinterpret_cast<RTCRayN*>(packets), 16, count, sizeof(RTCRay16));
}

#endif

}  // namespace sightlines
