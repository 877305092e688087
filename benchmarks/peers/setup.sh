#!/usr/bin/env bash
# Makes the peers' virtual environments under the folder named as the one argument.
set -euo pipefail
folder=${1:?usage: setup.sh DIR}
mkdir -p "$folder"
python3 -m venv "$folder/v1"
"$folder/v1/bin/pip" install --quiet torch==2.13.0
"$folder/v1/bin/pip" install --quiet vmas ir-sim stable-baselines3
python3 -m venv "$folder/v2" # imitation needs an older Gymnasium and stable-baselines3
"$folder/v2/bin/pip" install --quiet torch==2.13.0
"$folder/v2/bin/pip" install --quiet imitation==1.0.1 'numpy<2' 'setuptools<81' tensorboard
python3 -m venv "$folder/v3"
"$folder/v3/bin/pip" install --quiet jax jaxmarl
