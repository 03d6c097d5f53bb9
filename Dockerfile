# The command in a small image:
#   docker build -t signorini .
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" signorini run case.toml
FROM rust:1-slim-bookworm AS build
WORKDIR /source
COPY . .
RUN cargo build --release --locked -p signorini-cli && sh scripts/licences.sh signorini-cli > THIRD-PARTY.txt

FROM debian:bookworm-slim
COPY --from=build /source/target/release/signorini /usr/local/bin/signorini
COPY --from=build /source/LICENSE-MIT /source/LICENSE-APACHE /source/THIRD-PARTY.txt /usr/local/share/doc/signorini/
WORKDIR /work
USER 65534:65534
ENTRYPOINT ["signorini"]
CMD ["--help"]
