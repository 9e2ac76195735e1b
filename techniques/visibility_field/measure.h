// What a field saves: the same samples with it and without, timed.
#pragma once

#include "techniques/visibility_field/render.h"

namespace sightlines::visibility_field {

/// Seconds are medians of all repetitions, which take turns so that a machine that is busy for a while hurts both
/// alike.
struct FieldMeasurement {
    double seconds_without = 0.0, seconds_with = 0.0;
    double seconds_sampling = 0.0;  ///< of seconds_with: making, looking up and sorting out the samples; 0
                                    ///< where these have weights of their own
    SampleCounts without, with;
    SampleCounts second_rays;  ///< of `with`, where there is indirect light
    IrradianceError error;     ///< of the picture with the field

    double speed_up() const { return seconds_with > 0.0 ? seconds_without / seconds_with : 0.0; }
};

/// The picture is made `repetitions` times each way (at least once), after one round that does not count. `indirect`:
/// where not null, the scene, whose surfaces light each other once (one_bounce.h).
FieldMeasurement measure(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                         int repetitions, Progress& progress, const Scene* indirect = nullptr);

}  // namespace sightlines::visibility_field
