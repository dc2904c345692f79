// ensemble.cc -- pendulums of one's own, each with its own parameters and start, advanced side by
// side, and what each of them settles on; in C++.
#include <cstdio>
#include <memory>
#include <vector>

#include <pendres/pendres.h>

int main()
{
  const std::size_t n = 256;
  std::vector<pendres_pendulum> pendulums(n);
  std::vector<double> x(n), v(n, 0.0), error(n);
  std::vector<pendres_settled> outcome(n);
  int count[PENDRES_LABEL_COUNT] = {0};
  pendres_context *raw = nullptr;

  if (pendres_context_create(nullptr, &raw)) return 1;
  const std::unique_ptr<pendres_context, void (*)(pendres_context *)> ctx(raw, pendres_context_free);

  for (std::size_t i = 0; i < n; i++) {
    pendulums[i].damping = 0.1 + 0.2 * i / n;
    pendulums[i].drive_amplitude = 0.2;
    pendulums[i].drive_frequency = 0.8;
    x[i] = -1.5 + 6.0 * ((37 * i) % n) / n;
  }
  if (pendres_strobe_advance(ctx.get(), n, pendulums.data(), x.data(), v.data(), 10, error.data()) ||
      pendres_settle(ctx.get(), n, pendulums.data(), x.data(), v.data(), outcome.data(), nullptr)) {
    std::fprintf(stderr, "%s\n", pendres_context_message(ctx.get()));
    return 1;
  }
  for (const pendres_settled &o : outcome) count[o.label]++;
  for (int label = 0; label < PENDRES_LABEL_COUNT; label++)
    if (count[label])
      std::printf("%s: %d of %zu\n", pendres_name_get(PENDRES_NAMES_LABEL, label), count[label],
                  n);
  std::printf("the first after 10 periods: x = %.9f +- %.0e\n", x[0], error[0]);
}
