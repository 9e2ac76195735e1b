#include "techniques/visibility_field/measure.h"

#include <algorithm>
#include <vector>

#include "techniques/base/median.h"
#include "techniques/visibility_field/one_bounce.h"

namespace sightlines::visibility_field {

FieldMeasurement measure(const VisibilityField& field, const EmbreeScene& embree, const EnvironmentRequest& request,
                         int repetitions, Progress& progress, const Scene* indirect) {
    const auto picture = [&](const VisibilityField* by) {
        const auto direct = [&](const EnvironmentRequest& asked) {
            return render_environment(by, embree, asked, progress);
        };
        return indirect == nullptr ? direct(request)
                                   : with_one_bounce(by, embree, *indirect, request, direct, progress);
    };
    FieldMeasurement measured;
    std::vector<double> without, with, sampling;
    for (int k = -1; k < std::max(1, repetitions); ++k) {
        const EnvironmentResult reference = picture(nullptr);
        const EnvironmentResult ours = picture(&field);
        double sampling_seconds = 0.0;
        if (!is_weighted(request)) count_samples(&field, request, sampling_seconds);
        if (k < 0) {
            measured.without = reference.counts;
            measured.with = ours.counts;
            measured.second_rays = ours.second_rays;
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
