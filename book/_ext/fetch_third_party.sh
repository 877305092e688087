#!/usr/bin/env bash
# Fetch the front-end files that the pages need, pinned, and keep only what they load.
# The result is committed: building the book needs neither npm nor a network. Needs npm and tar.
set -euo pipefail
cd "$(dirname "$0")/../.."

site=book/_static/third-party
slides=book/_slides/third-party
axe=tests/book/third-party
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

get() { # NAME@VERSION FOLDER
  local tarball
  tarball=$(cd "$work" && npm pack --silent "$1" 2>/dev/null)
  mkdir -p "$work/$2" && tar xzf "$work/$tarball" -C "$work/$2" --strip-components=1
}

get mathjax@3.2.2 mathjax
get reveal.js@5.2.1 reveal
get axe-core@4.14.1 axe-core

keep="$work/keep"
mkdir -p "$keep"/mathjax/{output/chtml/fonts,input/tex,a11y,sre/mathmaps}

mj="$work/mathjax/es5"
cp "$mj/tex-mml-chtml.js" "$work/mathjax/LICENSE" "$keep/mathjax/"
cp -r "$mj/output/chtml/fonts/woff-v2" "$keep/mathjax/output/chtml/fonts/"
cp -r "$mj/input/tex/extensions" "$keep/mathjax/input/tex/"
cp "$mj"/a11y/*.js "$keep/mathjax/a11y/"
cp "$mj"/sre/mathmaps/{base,en,fr}.json "$keep/mathjax/sre/mathmaps/"

mkdir -p "$site/mathjax" && cp -r "$keep/mathjax/." "$site/mathjax/"
mkdir -p "$slides/reveal"
cp "$work"/reveal/dist/reveal.{js,css} "$work/reveal/plugin/notes/notes.js" "$work/reveal/LICENSE" "$slides/reveal/"
mkdir -p "$axe" && cp "$work"/axe-core/{axe.min.js,LICENSE} "$axe/"
du -sh "$site" "$slides" "$axe"
