# Runs on a bare Debian: the wheel by pip, the README's Python examples, the tests of the module.
cd /montelux
apt-get -qq update
apt-get -qq install --no-install-recommends python3-venv >/dev/null
python3 -m venv /environment
# By pip's own choice among the wheels: a wrong tag is refused.
/environment/bin/python -m pip install --quiet --disable-pip-version-check --find-links . --only-binary montelux 'montelux[test]'
/environment/bin/python -m pip show montelux | sed -n '1,2p'
mkdir /use
cd /use
ln -s /montelux/scenes scenes
awk '/^```python$/ {inside = 1; next} /^```$/ {inside = 0} inside' /montelux/README.md >example.py
test -s example.py
/environment/bin/python example.py
test -s studio.png
/environment/bin/python -m pytest -q -p no:cacheprovider /montelux/python/tests
