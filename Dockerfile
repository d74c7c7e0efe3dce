# docker build -t lilytank . && docker run --rm -v "$PWD:/work" lilytank run /usr/share/lilytank/scenarios/chain5.toml
FROM debian:bookworm-slim AS build
COPY . /lilytank
WORKDIR /lilytank
RUN bash -c 'source .ci/packages.sh && need_packages "${build_packages[@]}" libnetcdf-dev dpkg-dev file \
    && configure build -DCMAKE_BUILD_TYPE=Release -DLILYTANK_TESTS=OFF -DLILYTANK_BENCH=OFF' \
    && cmake --build build && cpack --config build/CPackConfig.cmake -B /deb

FROM debian:bookworm-slim
COPY --from=build /deb/lilytank_*.deb /tmp/
RUN apt-get -qq update && apt-get -qq install -y --no-install-recommends /tmp/*.deb ffmpeg fonts-dejavu-core \
    && rm -rf /tmp/*.deb /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["lilytank"]
