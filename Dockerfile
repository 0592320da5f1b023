# HIRES on Debian 12. `docker build -t hires . && docker run --rm hires` prints the README's first ranking;
# `docker run --rm hires hires --help` and so on run anything else.
FROM debian:12 AS build
COPY . /hires
RUN /hires/scripts/setup build perception run package \
    && mkdir /packages && HIRES_BUILD=/build /hires/scripts/package /packages

FROM debian:12
COPY --from=build /packages /packages
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /packages/*.deb \
    && rm -rf /packages /var/lib/apt/lists/*
CMD ["hires", "imagine", "--local", "--world", "/usr/share/hires/worlds/workshop.world", "--from", "dock", \
     "--object", "peppermill1", "--action", "move_base_param", "--arg", "atBench,farCorner", \
     "--arg", "slow,fast", "--rollouts", "64", "--seed", "7"]
