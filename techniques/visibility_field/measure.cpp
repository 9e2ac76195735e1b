#include "techniques/visibility_field/measure.h"

#include <algorithm>
#include <vector>

#include "techniques/base/median.h"

namespace sightlines::visibility_field {

FieldMeasurement measure(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                         int repetitions, Progress& progress) {
    FieldMeasurement measured;
    std::vector<double> without, with, sampling;
    for (int k = -1; k < std::max(1, repetitions); ++k) {
        const EnvironmentResult reference = render_environment(nullptr, embree, request, progress);
        const EnvironmentResult ours = render_environment(&field, embree, request, progress);
        double sampling_seconds = 0.0;
        if (!is_weighted(request)) count_samples(&field, request, sampling_seconds);
        if (k < 0) {
            measured.without = reference.counts;
            measured.with = ours.counts;
            measured.error = compare_irradiance(ours, reference, request);
            continue;
        }
        without.push_back(reference.seconds);
        with.push_back(ours.seconds);
        sampling.push_back(sampling_seconds);
    }
    measured.seconds_without = median(without);
    measured.seconds_with = median(with);
    measured.seconds_sampling = median(sampling);
    return measured;
}

}  // namespace sightlines::visibility_field
