#!/bin/sh
# Makes DejaVuSans.ttf from the full font: subset.sh /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
# Needs fonttools (4.68.0 was used): python3 -m pip install fonttools==4.68.0
set -eu
pyftsubset "$1" --output-file="$(dirname "$0")/DejaVuSans.ttf" \
    --layout-features='' --no-hinting --drop-tables+=GPOS,GSUB,GDEF,kern,FFTM,DSIG \
    --notdef-outline --name-IDs='*' --no-recalc-timestamp \
    --unicodes="U+0020-007E,U+00A0-017F,U+0192,U+0218-021B,U+02C6,U+02C7,U+0300,U+0307,U+0370-03FF,U+0400-045F,U+1E02-1EF3,U+2010-2015,U+2018-201E,U+2020-2022,U+2026,U+2030,U+2032,U+2033,U+2039,U+203A,U+2070-208E,U+20AC,U+2103,U+2109,U+2113,U+2116,U+2126,U+2190-2199,U+21CC,U+21D0-21D4,U+2200-2209,U+220F-2213,U+2215-221F,U+2225-222B,U+2236,U+223C,U+2245,U+2248,U+2260-2265,U+226A,U+226B,U+2282-2287,U+22A5,U+22C5,U+25A0-25CF,U+2605,U+2606,U+2713,U+2717,U+FFFD"
