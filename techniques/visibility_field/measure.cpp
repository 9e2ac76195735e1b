#include "techniques/visibility_field/measure.h"

#include <algorithm>
#include <limits>

namespace sightlines::visibility_field {

FieldMeasurement measure(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                         int repetitions, Progress& progress) {
    FieldMeasurement measured;
    measured.seconds_without = measured.seconds_with = measured.seconds_sampling =
        std::numeric_limits<double>::infinity();
    for (int k = 0; k < std::max(1, repetitions); ++k) {
        const EnvironmentResult reference = render_environment(nullptr, embree, request, progress);
        const EnvironmentResult ours = render_environment(&field, embree, request, progress);
        double sampling = 0.0;
        count_samples(&field, request, sampling);
        measured.seconds_without = std::min(measured.seconds_without, reference.seconds);
        measured.seconds_with = std::min(measured.seconds_with, ours.seconds);
        measured.seconds_sampling = std::min(measured.seconds_sampling, sampling);
        measured.without = reference.counts;
        measured.with = ours.counts;
        measured.error = compare_irradiance(ours, reference, request);
    }
    return measured;
}

}  // namespace sightlines::visibility_field
