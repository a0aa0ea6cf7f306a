#include "montelux/transport/volume_path_integrator.h"

#include "montelux/mc/random/sample_stream.h"
#include "montelux/transport/volume_path.h"

namespace montelux {

template FilmContribution VolumePathIntegrator::estimate(const SceneView&, RayTracer&, const CameraSample&,
                                                         SampleStream&, PathRecord*) const;

} // namespace montelux
