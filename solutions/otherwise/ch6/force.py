"""6.1 with complex numbers, one circle after the other."""


def force(place, target, circles, attraction, fading, repulsion, influence):
    here, pull = complex(*place), complex(*target) - complex(*place)
    if abs(pull) > fading:
        pull *= fading / abs(pull)
    push = 0j
    for x, y, radius in circles:
        out = here - complex(x, y)
        rho = max(abs(out) - radius, 0.1)
        if rho < influence:
            slope = repulsion * (rho**-1 - influence**-1) * rho**-2
            push += slope * out / abs(out)
    pull *= attraction
    return [(pull.real, pull.imag), (push.real, push.imag)]
