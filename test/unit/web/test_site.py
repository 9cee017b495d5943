"""Who is let in to the window."""

import re
import socket
import urllib.error
import urllib.request
from contextlib import closing

import pytest
from support.browser import Browser
from support.patience import wait_until
from websockets.exceptions import InvalidStatus

from rosbots_description.web import Site, WindowError


@pytest.fixture
def public():
    """A window for all; its address is the one by which this machine reaches it."""
    site = Site('0.0.0.0', 0)
    site.address = f'http://127.0.0.1:{site.get_port()}/'
    yield site
    site.stop()


def get(address, **headers):
    """Return status, headers and text of an answer."""
    request = urllib.request.Request(address, headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=60) as answer:
            return answer.status, answer.headers, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.headers, error.read().decode()


def refusal(address, **headers):
    status, _, text = get(address, **headers)
    assert status == 403
    assert re.fullmatch(r'[^\n]+\.\n', text)  # a sentence
    return text


def test_this_machine_is_let_in_without_a_token(site, capfd):
    assert site.token == ''
    status, _, text = get(site.address)
    assert (status, '<html' in text) == (200, True)
    with Browser(site.address) as browser:
        browser.wait_until(lambda: browser.messages)
    assert capfd.readouterr().out == ''  # viser is not asked to tell


def test_what_is_sent_to_a_browser_that_has_left_makes_no_noise(recwarn):
    site = Site('127.0.0.1', 0)
    try:
        with Browser(site.address) as browser:
            browser.wait_until(site.get_clients)
            (client,) = site.get_clients().values()
        wait_until(lambda: not site.get_clients())
        client.send_file_download('a', b'a')
    finally:
        site.stop()
    assert not [one for one in recwarn if 'closed connection' in str(one.message)]


@pytest.mark.parametrize('name', ['localhost', '127.0.0.1'])
def test_a_tunnel_to_this_machine_is_let_in(site, name):
    assert get(site.address, Host=f'{name}:9999')[0] == 200


def test_other_pages_in_the_same_browser_are_not(site):
    assert 'other pages' in refusal(site.address, Origin='http://evil.example')
    assert 'this machine only' in refusal(site.address, Host='evil.example')
    with pytest.raises(InvalidStatus):
        Browser(site.address, {'Origin': 'http://evil.example'})


@pytest.mark.parametrize('headers', [{'Host': '['}, {'Origin': 'http://['}])
def test_a_malformed_address_is_refused_in_a_sentence(site, headers):
    assert 'malformed' in refusal(site.address, **headers)


def test_a_token_is_needed_elsewhere(public):
    assert len(public.token) > 20
    for address in (public.address, f'{public.address}?token=', f'{public.address}?token=x',
                    f'{public.address}?token=%FF'):
        assert 'token' in refusal(address)
    refusal(public.address, Cookie=f'rosbots_window_{public.get_port()}=x')
    refusal(public.address, Cookie='a[]=1; =;;')
    with pytest.raises(InvalidStatus):
        Browser(public.address)


def test_who_had_the_token_once_is_known_by_a_cookie(public):
    status, headers, _ = get(f'{public.address}?token={public.token}')
    assert status == 200
    cookie, *rest = headers['Set-Cookie'].split('; ')
    assert set(rest) == {'HttpOnly', 'SameSite=Strict'}
    with Browser(public.address, {'Cookie': cookie}) as browser:
        browser.wait_until(lambda: browser.messages)


def test_the_address_for_others_has_name_and_token():
    site = Site('0.0.0.0', 0, 'secret')
    try:
        assert site.address == f'http://{socket.gethostname()}:{site.get_port()}/?token=secret'
    finally:
        site.stop()


@pytest.mark.parametrize('path', ['../site.py', '%2e%2e/site.py', '..%5csite.py', 'etc/passwd'])
def test_a_path_that_climbs_leads_nowhere(site, path):
    assert get(site.address + path)[0] == 404


def test_the_page_is_not_published_through_other_servers(site):
    assert site.request_share_url() is None


def test_a_port_in_use_is_refused_in_a_sentence():
    with closing(socket.create_server(('127.0.0.1', 0))) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(WindowError, match=rf'no window at 127\.0\.0\.1, port {port}: Address '
                                              'already in use; web_port'):
            Site('127.0.0.1', port)


@pytest.mark.parametrize(('host', 'port'), [
    ('192.0.2.1', 0), ('no such host', 0), ('127.0.0.1', 99999), ('127.0.0.1', -1), ('a' * 70, 1),
])
def test_an_address_of_another_machine_is_refused_in_a_sentence(host, port):
    with pytest.raises(WindowError, match=r'^no window at .*, port -?\d+: .+; web_port and web_'):
        Site(host, port)
