# The book and its tools in one image.
#
#   docker build -t robonav .                                     --build-arg PIP_OPTIONS=... as in README.md
#   docker run --rm -p 8888:8888 robonav                          JupyterLab on the notebooks
#   docker run --rm -v "$PWD/site:/robonav/_build/html" robonav make book
#
# The strongest sandbox of the grader needs user namespaces: docker run --security-opt seccomp=unconfined ...
FROM python:3.11-slim-bookworm

RUN apt-get update \
 && apt-get install --yes --no-install-recommends bubblewrap chromium git make nodejs \
 && rm -rf /var/lib/apt/lists/*

# A user of its own, because Chromium and the grader's sandbox refuse or weaken under root.
RUN useradd --create-home student && install --directory --owner student /robonav
USER student
WORKDIR /robonav

# The libraries have a layer of their own, which a change of the sources leaves as it is.
ARG PIP_OPTIONS=""
COPY --chown=student requirements.lock ./
RUN python -m venv .venv \
 && .venv/bin/python -m pip install --quiet --no-cache-dir ${PIP_OPTIONS} "$(grep '^torch==' requirements.lock)" \
 && .venv/bin/python -m pip install --quiet --no-cache-dir ${PIP_OPTIONS} -r requirements.lock

COPY --chown=student . ./
RUN make install PIP_OPTIONS="${PIP_OPTIONS}"

EXPOSE 8888
CMD ["make", "lab", "LAB_OPTIONS=--ip=0.0.0.0 --no-browser"]
