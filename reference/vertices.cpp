#include "reference/vertices.h"

#include "reference/sampler.h"

namespace voxref {

void Vertices::add(const SurfacePoint& point, const glm::vec3& to_previous) {
  const size_t i = size_++;
  const Reflectance& r = point.reflectance;
  position_.set(i, point.position);
  geometric_normal_.set(i, point.geometric_normal);
  normal_.set(i, point.shading_normal);
  out_.set(i, to_previous);
  diffuse_.set(i, r.diffuse);
  specular_f0_.set(i, r.specular_f0);
  specular_f1_.set(i, r.specular_f1);
  layer_f0_[i] = r.layer_f0;
  layer_f1_[i] = r.layer_f1;
  alpha_[i] = r.alpha;
  specular_share_[i] = specular_share(r, glm::dot(point.shading_normal, to_previous));
  lambertian_ = lambertian_ && Bsdf::is_lambertian(r);
}

inline Bsdf Vertices::bsdf(size_t i, bool lambertian) const {
  Reflectance r;
  r.diffuse = diffuse_[i];
  r.layer_f0 = layer_f0_[i];
  r.layer_f1 = layer_f1_[i];
  r.specular_f0 = specular_f0_[i];
  r.specular_f1 = specular_f1_[i];
  r.alpha = alpha_[i];
  return {r, normal_[i], geometric_normal_[i], out_[i], specular_share_[i], lambertian};
}

VOXREF_WIDEST void Vertices::evaluate(const Lanes3& in, Lanes3& value, Lanes<float>& pdf) const {
  const auto evaluate_all = [&](bool lambertian) __attribute__((always_inline)) {
    VOXREF_INDEPENDENT
    for (size_t i = 0; i < size_; ++i) {
      const Bsdf here = bsdf(i, lambertian);
      value.set(i, here.value(in[i]));
      pdf[i] = here.pdf(in[i]);
    }
  };
  lambertian_ ? evaluate_all(true) : evaluate_all(false);
}

VOXREF_WIDEST void Vertices::sample(const uint32_t* choice, const uint32_t* x, const uint32_t* y, Lanes3& in,
                                    Lanes3& weight, Lanes<float>& pdf) const {
  const auto sample_all = [&](bool lambertian) __attribute__((always_inline)) {
    VOXREF_INDEPENDENT
    for (size_t i = 0; i < size_; ++i) {
      const BsdfSample sample = bsdf(i, lambertian).sample(unit_float(choice[i]), {unit_float(x[i]), unit_float(y[i])});
      in.set(i, sample.in);
      weight.set(i, sample.weight);
      pdf[i] = sample.pdf;
    }
  };
  lambertian_ ? sample_all(true) : sample_all(false);
}

}  // namespace voxref
